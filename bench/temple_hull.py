#!/usr/bin/python3
"""bench/temple_hull.py [--program build/release/photohull] [--data ../shared] [--out bench/results/temple_hull.json]

Measures the hull of templeRing at two resolutions, from photographs to files, for docs/measurements/benchmarks.md. Each run is a
process of its own; CPU seconds are user + system of the whole process. Run it twice on a new machine: the first run
of a shader compiles it, later ones read it from the driver's cache."""
import argparse, json, os, subprocess, sys, tempfile

def reconstruct(program, scene, out, *options):
    run = subprocess.run([program, 'reconstruct', scene, '--out', out, '--json', *options], capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit('%s %s failed (%d): %s' % (scene, ' '.join(options), run.returncode, run.stderr.strip()))
    return json.loads(run.stdout)

def stage(report, name):
    return next(s['cpu_seconds'] for s in report['stages'] if s['name'] == name)

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
    p.add_argument('--out', default='bench/results/temple_hull.json')
    p.add_argument('--repeat', type=int, default=5, help='runs; the median counts')
    a = p.parse_args()
    if not os.path.isdir(os.path.join(a.data, 'datasets')):
        raise SystemExit(a.data + ': no datasets/ there; give --data')
    with tempfile.TemporaryDirectory() as folder:
        print('| resolution | hull CPU s | process CPU s | wall s | peak MB |\n|---|---|---|---|---|')
        rows = hull_table(a, folder)
    os.makedirs(os.path.dirname(a.out) or '.', exist_ok=True)
    json.dump(rows, open(a.out, 'w'), indent=1)

if __name__ == '__main__':
    main()
