#!/usr/bin/python3
"""bench/estimates.py [--program build/release/photohull] [--datasets ../shared/datasets] [--results bench/results/estimates.json] [--fresh | --again | --fit]

What `photohull info` says that a run will cost, against what `photohull reconstruct` then takes: peak memory and CPU time,
over scenes, methods, resolutions and masks (RUNS). Prints the table of docs/guide/limits.md and the ratios taken / said that are worst.
Runs that --results does not hold yet are made, one after the other, and kept there as they end (all: about 25 minutes on two idle
cores; --fresh makes all of them anew). --again only asks `info` anew, and --fit prints the constants of
src/pipeline/estimate.cpp that suit the kept runs best."""
import argparse, json, math, os, subprocess, tempfile

# Constants that these runs hardly tell, at least: decoding, by the large photographs of docs/guide/limits.md;
# a hull's bricks; sweeps of all of a box at 256 voxels, by runs of an earlier version.
KNOWN = {'kPixelSeconds': 1e-8, 'kHullFaceSeconds': 2e-6, 'kUnmaskedSweepFaceBytes': 1200}
FAIR = 1.5  # the factor that estimates are to be within

def runs():
    """(scene, masks, method, resolution); resolution None: as the pixels ask. What tells most of the model comes first."""
    out = [('fountain', 'none', 'refine', 256), ('fountain', 'none', 'refine', 128), ('fountain', 'none', 'refine', 500),
           ('bunny', 'auto', 'hull', 256), ('templeSparseRing', 'auto', 'refine', None)]
    for scene in ('glazed', 'plaster', 'tabletop', 'bunny', 'armadillo', 'fandisk', 'trellis', 'templeSparseRing', 'templeRing'):
        out += [(scene, masks, 'refine', 256) for masks in ('none', 'auto')]
    out += [('bunny', 'auto', 'space-carving', 256), ('fandisk', 'none', 'space-carving', 128), ('templeSparseRing', 'none', 'space-carving', 128),
            ('templeSparseRing', 'auto', 'hull', 256), ('trellis', 'auto', 'hull', 400)]
    for scene in ('bunny', 'tabletop', 'fandisk', 'templeRing'):
        out += [(scene, masks, 'refine', 128) for masks in ('none', 'auto')]
    out += [('armadillo', 'auto', 'refine', 400), ('tabletop', 'none', 'refine', 400), ('bunny', 'none', 'refine', 400),
            ('trellis', 'auto', 'refine', 400), ('glazed', 'none', 'refine', 400)]
    out += [('fandisk', 'auto', 'space-carving', 256), ('trellis', 'auto', 'space-carving', 128), ('bunny', 'none', 'space-carving', 128),
            ('fandisk', 'none', 'space-carving', 256), ('templeRing', 'auto', 'hull', 256), ('dinoRing', 'auto', 'refine', 256), ('fountain', 'none', 'refine', None)]
    return out

def call(program, *arguments):
    run = subprocess.run([program, *arguments], capture_output=True, text=True)
    if run.returncode not in (0, 3):
        raise SystemExit('%s failed (%d): %s' % (' '.join(arguments), run.returncode, run.stderr.strip()))
    return json.loads(run.stdout)

def options_of(run):
    scene, masks, method, resolution = run
    return ['--masks', masks, '--method', method] + (['--resolution', str(resolution)] if resolution else [])

def path_of(datasets, scene):
    folder = os.path.join(datasets, scene)
    par = os.path.join(folder, scene + '_par.txt')
    return par if scene == 'fountain' else folder

def ask(a, run):
    """What is said before the run, and what it is said from."""
    info = call(a.program, 'info', path_of(a.datasets, run[0]), '--json', *options_of(run))
    pixels = sum(v['width'] * v['height'] for v in info['views'])
    size = [m - n for m, n in zip(info['box']['max'], info['box']['min'])]
    n = [8 * math.ceil((s / info['voxel_size'] + 6) / 8) for s in size]
    given = any(v['mask'] for v in info['views'])
    return {'said_bytes': info['memory_bytes'], 'said_cpu': info['cpu_seconds'], 'views': len(info['views']),
            'file_pixels': pixels, 'read_pixels': pixels * info['image_scale'] ** 2, 'voxels': n,
            'masks': 'none' if run[1] == 'none' else 'given' if given else 'made'}

def taken(report):
    return {'bytes': report['peak_memory_bytes'], 'cpu': report['cpu_seconds'], 'bricks': report['grid']['bricks_stored'],
            'vertices': report['mesh']['vertices'], 'surfels': [level['surfels'] for level in report.get('refine', [])],
            'grid': report['grid']['voxels'],
            'stages': {s['name']: {'cpu': round(s['cpu_seconds'], 3), 'peak': s['peak_memory_bytes']} for s in report['stages']}}

def measure(a, run):
    with tempfile.TemporaryDirectory() as out:
        return taken(call(a.program, 'reconstruct', path_of(a.datasets, run[0]), '--out', out, '--device', 'software', '--json', *options_of(run)))

def key(run):
    return '%s %s %s %s' % run

def surface(r):
    """Faces of the box, in voxels."""
    x, y, z = r['voxels']
    return 2 * (x * y + y * z + z * x)

def memory_terms(r):
    """Constant of estimate.cpp: what it is multiplied by."""
    terms = {'kBaseBytes': 1, 'kPixelBytes': r['read_pixels']}
    if r['masks'] != 'none' or r['method'] == 'hull':
        terms['kFaceBytes'] = surface(r)
    elif r['method'] == 'refine':
        terms['kUnmaskedFaceBytes'] = surface(r)
    else:
        terms['kUnmaskedSweepFaceBytes'] = surface(r)
    return terms

def time_terms(r):
    terms = {'kBaseSeconds': 1, 'kPixelSeconds': r['file_pixels']}
    if r['masks'] == 'made':
        terms['kMadePixelSeconds'] = r['read_pixels']
    if r['method'] == 'hull':
        terms['kHullFaceSeconds'] = surface(r)
    elif r['method'] == 'refine':
        terms['kUnmaskedRefineFaceSeconds' if r['masks'] == 'none' else 'kRefineFaceSeconds'] = surface(r)
        if r['masks'] == 'none':
            terms['kUnmaskedPixelSeconds'] = r['read_pixels']
    else:
        terms['kUnmaskedSweepFaceSeconds' if r['masks'] == 'none' else 'kSweepFaceSeconds'] = surface(r)
    return terms

def fit(rows, terms_of, used, low):
    """Constants, none below its bound in `low`, whose largest factor between said and used is least."""
    import numpy as np
    from scipy.optimize import linprog
    names = sorted({name for r in rows for name in terms_of(r)})
    a = np.array([[terms_of(r).get(name, 0) / used(r) for name in names] for r in rows])
    scale = a.max(0)
    a = a / scale
    bounds = [(low.get(name, 0) * s, None) for name, s in zip(names, scale)]
    best, least, most = None, 1.0, 4.0
    while most - least > 1e-3:
        factor = math.sqrt(least * most)
        # Of what suits the factor the one that is nearest in the sum.
        found = linprog(a.sum(0), A_ub=np.vstack([a, -a]), b_ub=np.hstack([np.full(len(a), factor), np.full(len(a), -1 / factor)]), bounds=bounds)
        if found.success:
            best, most = found.x / scale, factor
        else:
            least = factor
    return dict(zip(names, best)), most

def table(rows):
    print('| scene, views | masks | method | resolution | MiB: said / taken | ratio | CPU s: said / taken | ratio |')
    print('|---' * 8 + '|')
    for r in rows:
        b, c = r['bytes'] / r['said_bytes'], r['cpu'] / r['said_cpu']
        mark = lambda x: '%.2f%s' % (x, '' if 1 / FAIR <= x <= FAIR else ' (!)')
        print('| %s, %d | %s | %s | %s | %.0f / %.0f | %s | %.0f / %.0f | %s |' % (
            r['scene'], r['views'], r['masks'], r['method'], r['resolution'] or 'default', r['said_bytes'] / 2**20, r['bytes'] / 2**20, mark(b),
            r['said_cpu'], r['cpu'], mark(c)))
    for what, said, used in (('memory', 'said_bytes', 'bytes'), ('CPU time', 'said_cpu', 'cpu')):
        ratios = [r[used] / r[said] for r in rows]
        beyond = sum(not 1 / FAIR <= x <= FAIR for x in ratios)
        print('%s: taken / said from %.2f to %.2f; %d of %d beyond a factor of %.1f' % (what, min(ratios), max(ratios), beyond, len(ratios), FAIR))

def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument('--program', default='build/release/photohull')
    p.add_argument('--datasets', default='../shared/datasets')
    p.add_argument('--results', default='bench/results/estimates.json')
    p.add_argument('--fresh', action='store_true')
    p.add_argument('--again', action='store_true')
    p.add_argument('--fit', action='store_true')
    a = p.parse_args()
    kept = {}
    if os.path.exists(a.results) and not a.fresh:
        kept = {key((r['scene'], r['asked'], r['method'], r['resolution'])): r for r in json.load(open(a.results))}
    if not a.fit:
        for run in runs():
            row = kept.get(key(run))
            if row is None and a.again:
                continue
            if row is None or a.again:
                row = {**(row or {}), 'scene': run[0], 'asked': run[1], 'method': run[2], 'resolution': run[3], **ask(a, run)}
            if 'bytes' not in row:
                row.update(measure(a, run))
            kept[key(run)] = row
            json.dump(list(kept.values()), open(a.results, 'w'), indent=1)
    rows = [kept[key(run)] for run in runs() if key(run) in kept]
    if a.fit:
        for terms, used, low in ((memory_terms, lambda r: r['bytes'], KNOWN), (time_terms, lambda r: r['cpu'], KNOWN)):
            constants, factor = fit(rows, terms, used, low)
            for name, value in constants.items():
                print('%-28s %.3g' % (name, value))
            print('within a factor of %.2f' % factor)
    table(rows)

if __name__ == '__main__':
    main()
