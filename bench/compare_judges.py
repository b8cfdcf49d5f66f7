#!/usr/bin/python3
"""bench/compare_judges.py [--program build/release/photohull] [--data ../shared] [--scenes bunny,...]
                          [--methods hull,space-carving] [--resolution 128] [--samples 200000]

Reconstructs scenes with exact truth, judges every mesh with `photohull evaluate` and with
DATA/tools/evaluate.py, and prints the tables of docs/guide/evaluate.md: some figures of both side by side, the
greatest relative difference over all figures that both give (save the maxima, which hang on single samples),
the same between two seeds of evaluate.py for comparison, and the seconds that each took."""
import argparse, json, os, subprocess, tempfile, time

DISTANCES = ('mean', 'median', 'rms', 'q95')

def run(*command):
    r = subprocess.run(command, capture_output=True, text=True)
    if r.returncode != 0:
        raise SystemExit('%s failed (%d): %s' % (' '.join(command), r.returncode, r.stderr.strip()))
    return r.stdout

def timed(*command):
    start = time.perf_counter()
    return run(*command), time.perf_counter() - start

def reference(a, mesh, scene, seed):
    out = mesh + '.%d.json' % seed
    _, seconds = timed('/usr/bin/python3', os.path.join(a.data, 'tools/evaluate.py'), mesh, scene, '--json', out,
                       '--samples', str(a.samples), '--seed', str(seed))
    return json.load(open(out)), seconds

def ours(a, mesh, scene):
    text, seconds = timed(a.program, 'evaluate', mesh, '--truth', scene, '--json', '--samples', str(a.samples))
    return json.loads(text), seconds

def figures(r):
    """every figure that both judges give, by name"""
    f = {k: r[k] for k in ('accuracy', 'completeness', 'hausdorff95', 'chamfer_mean')}
    for side in ('recon_to_gt', 'gt_to_recon'):
        f.update({side + '.' + k: r[side][k] for k in DISTANCES})
    f.update({'seen.' + k: r['seen'][k] for k in ('share', 'accuracy', 'median')})
    for part, name in ((r, ''), (r['seen'], 'seen.')):
        for row in part.get('f') or part['thresholds']:
            f.update({'%s%s@%g%%' % (name, k, 100 * row['t']): row[k] for k in ('precision', 'recall', 'f')})
    return f

def greatest(a, b):
    """name and relative difference of the figures that differ most"""
    name = max(a, key=lambda k: abs(a[k] - b[k]) / abs(b[k]) if b[k] else float(a[k] != b[k]))
    return name, abs(a[name] - b[name]) / abs(b[name]) if b[name] else float(a[name] != b[name])

def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument('--program', default='build/release/photohull')
    p.add_argument('--data', default='../shared')
    p.add_argument('--scenes', default='bunny,armadillo,fandisk,trellis,plaster')
    p.add_argument('--methods', default='hull,space-carving')
    p.add_argument('--resolution', type=int, default=128)
    p.add_argument('--samples', type=int, default=200000)
    p.add_argument('--keep', help='folder of the meshes; those that are there are not made again')
    a = p.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = a.keep or scratch
        print('| mesh | accuracy, seen (% of diagonal) | completeness (%) | F 0.1 %, seen | F 0.5 %, seen | greatest '
              'difference | between seeds | seconds |\n|---|---|---|---|---|---|---|---|')
        for scene in a.scenes.split(','):
            path = os.path.join(a.data, 'datasets', scene)
            for method in a.methods.split(','):
                out = os.path.join(folder, '%s_%s_%d' % (scene, method, a.resolution))
                mesh = os.path.join(out, 'mesh.ply')
                if not os.path.exists(mesh):
                    run(a.program, 'reconstruct', path, '--out', out, '--method', method, '--resolution', str(a.resolution))
                (theirs, their_s), (other, _), (mine, my_s) = reference(a, mesh, path, 1), reference(a, mesh, path, 2), ours(a, mesh, path)
                x, y, z = figures(mine), figures(theirs), figures(other)
                assert set(x) == set(y)
                d = 100 / theirs['gt_diagonal']
                pair = lambda k, scale: '%.4g / %.4g' % (scale * x[k], scale * y[k])
                name, worst = greatest(x, y)
                print('| %s, %s | %s | %s | %s | %s | %.2f %% (%s) | %.2f %% | %.1f / %.1f |' % (
                    scene, method, pair('seen.accuracy', d), pair('completeness', 100), pair('seen.f@0.1%', 100),
                    pair('seen.f@0.5%', 100), 100 * worst, name, 100 * greatest(z, y)[1], my_s, their_s), flush=True)

if __name__ == '__main__':
    main()
