#!/usr/bin/python3
"""bench/scenes.py [--program build/release/photohull] [--data ../shared] [--out bench/results/scenes.json]
                   [--scenes bunny,...] [--methods hull,...] [--resolution 256]

Reconstructs scenes with exact truth by every method, judges the meshes with DATA/tools/evaluate.py, measures
the hull of templeRing at two resolutions against DATA/baselines, and prints the tables of docs/benchmarks.md.
Each run is a process of its own; CPU seconds are user + system of the whole process. Run everything twice on
a new machine: the first run of a shader compiles it, later ones read it from the driver's cache."""
import argparse, json, os, subprocess, sys, tempfile

def reconstruct(program, scene, out, *options):
    run = subprocess.run([program, 'reconstruct', scene, '--out', out, '--json', *options], capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit('%s %s failed (%d): %s' % (scene, ' '.join(options), run.returncode, run.stderr.strip()))
    return json.loads(run.stdout)

def judge(data, mesh, scene):
    out = mesh + '.json'
    subprocess.run(['/usr/bin/python3', os.path.join(data, 'tools/evaluate.py'), mesh, scene, '--json', out],
                   check=True, stdout=subprocess.DEVNULL)
    r = json.load(open(out))
    f = {t['t']: 100 * t['f'] for t in r['seen']['thresholds']}
    return {'f01': f[0.001], 'f025': f[0.0025], 'f05': f[0.005], 'completeness05': 100 * r['completeness'],
            'acc90': 100 * r['seen']['accuracy'] / r['gt_diagonal']}

def stage(report, name):
    return next(s['cpu_seconds'] for s in report['stages'] if s['name'] == name)

def truth_table(a, folder):
    rows = []
    for scene in a.scenes.split(','):
        path = os.path.join(a.data, 'datasets', scene)
        for method in a.methods.split(','):
            out = os.path.join(folder, scene + '_' + method)
            r = reconstruct(a.program, path, out, '--method', method, '--resolution', str(a.resolution))
            row = {'scene': scene, 'method': method, 'cpu_s': r['cpu_seconds'], 'wall_s': r['wall_seconds'],
                   'peak_mb': r['peak_memory_bytes'] / 2**20, 'triangles': r['mesh']['triangles'],
                   **judge(a.data, os.path.join(out, 'mesh.ply'), path)}
            rows.append(row)
            print('| {scene} | {method} | {cpu_s:.1f} | {peak_mb:.0f} | {f01:.2f} | {f025:.2f} | {f05:.2f} | '
                  '{completeness05:.2f} | {acc90:.3f} | {triangles} |'.format(**row), flush=True)
    return rows

def hull_table(a, folder):
    rows = []
    path = os.path.join(a.data, 'datasets', 'templeRing')
    for resolution in (256, 512):
        runs = [reconstruct(a.program, path, os.path.join(folder, 'temple'), '--method', 'hull', '--resolution',
                            str(resolution)) for _ in range(a.repeat)]
        runs.sort(key=lambda r: r['cpu_seconds'])
        r = runs[len(runs) // 2]
        row = {'scene': 'templeRing', 'resolution': resolution, 'hull_cpu_s': stage(r, 'hull'),
               'process_cpu_s': r['cpu_seconds'], 'wall_s': r['wall_seconds'], 'peak_mb': r['peak_memory_bytes'] / 2**20}
        rows.append(row)
        print('| {resolution} | {hull_cpu_s:.2f} | {process_cpu_s:.2f} | {wall_s:.2f} | {peak_mb:.0f} |'.format(**row), flush=True)
    return rows

def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument('--program', default='build/release/photohull')
    p.add_argument('--data', default='../shared')
    p.add_argument('--out', default='bench/results/scenes.json')
    p.add_argument('--scenes', default='bunny,armadillo,fandisk,trellis,plaster,glazed')
    p.add_argument('--methods', default='hull,voxel-coloring,space-carving')
    p.add_argument('--resolution', type=int, default=256)
    p.add_argument('--repeat', type=int, default=5, help='runs of the hull; the median counts')
    a = p.parse_args()
    if not os.path.isdir(os.path.join(a.data, 'datasets')):
        raise SystemExit(a.data + ': no datasets/ there; give --data')
    with tempfile.TemporaryDirectory() as folder:
        print('| resolution | hull CPU s | process CPU s | wall s | peak MB |\n|---|---|---|---|---|')
        hull = hull_table(a, folder)
        print('\n| scene | method | CPU s | peak MB | F 0.1 % | F 0.25 % | F 0.5 % | completeness 0.5 % | acc90 % | triangles |\n' + '|---' * 10 + '|')
        truth = truth_table(a, folder)
    os.makedirs(os.path.dirname(a.out) or '.', exist_ok=True)
    json.dump({'resolution': a.resolution, 'hull': hull, 'truth': truth}, open(a.out, 'w'), indent=1)

if __name__ == '__main__':
    main()
