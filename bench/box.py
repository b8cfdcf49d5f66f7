#!/usr/bin/python3
"""bench/box.py [--program build/release/photohull] [--datasets ../shared/datasets] [--out bench/results/box.json] [SCENE ...]

The box that `photohull info --box auto` finds in each scene's photographs, against the truth: how much of it the box
holds, and its volume over the truth's own box. The truth is the vertices of gt.ply where the scene has it, and their
tight box; else the scene's known box itself, of which the box must then hold the volume (KNOWN for `fountain`). Prints the table of
docs/guide/box.md: by the masks that the scene has, and without masks."""
import argparse, json, os, subprocess, tempfile, time
import numpy as np

SCENES = 'templeRing dinoRing templeSparseRing armadillo bunny fandisk trellis plaster glazed tabletop fountain'.split()
KNOWN = {'fountain': [[-21, -13.2, -4.6], [-12.4, -8.5, 2.0]]}
LEAST_HELD, MOST_VOLUME = 0.995, 3

def inspect(program, scene, *arguments):
    before, start = os.times().children_user, time.time()
    run = subprocess.run([program, 'info', scene, '--json', *arguments], capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit('%s failed (%d): %s' % (scene, run.returncode, run.stderr.strip()))
    found = json.loads(run.stdout)
    found['cpu'], found['wall'] = os.times().children_user - before, time.time() - start
    return found

def ply_vertices(path):
    """Positions of a binary little-endian PLY whose vertices come first."""
    data = open(path, 'rb').read()
    end = data.index(b'end_header\n') + len(b'end_header\n')
    fields, count, element = [], 0, ''
    types = {'float': '<f4', 'float32': '<f4', 'double': '<f8', 'float64': '<f8', 'uchar': 'u1', 'uint8': 'u1', 'int': '<i4'}
    for words in (line.split() for line in data[:end].decode().splitlines()):
        if words[0] == 'element':
            element = words[1]
            count = int(words[2]) if element == 'vertex' else count
        elif words[0] == 'property' and element == 'vertex':
            fields.append((words[2], types[words[1]]))
    vertices = np.frombuffer(data[end:], dtype=fields, count=count)
    return np.stack([vertices[axis] for axis in 'xyz'], 1).astype(float)

def held_of(points, known, found):
    """Share of the truth that the found box holds."""
    if points is not None:
        return float(((points >= found[0]) & (points <= found[1])).all(1).mean())
    common = np.clip(np.minimum(known[1], found[1]) - np.maximum(known[0], found[0]), 0, None)
    return float(np.prod(common) / np.prod(known[1] - known[0]))

def truth_of(program, folder, name):
    """Vertices of the object, if they are known, and its box."""
    if os.path.exists(os.path.join(folder, 'gt.ply')):
        points = ply_vertices(os.path.join(folder, 'gt.ply'))
        return points, np.array([points.min(0), points.max(0)])
    if name in KNOWN:
        return None, np.array(KNOWN[name])
    known = inspect(program, folder)['box']
    return None, np.array([known['min'], known['max']])

def main():
    p = argparse.ArgumentParser()
    p.add_argument('--program', default='build/release/photohull')
    p.add_argument('--datasets', default='../shared/datasets')
    p.add_argument('--out')
    p.add_argument('scenes', nargs='*', default=SCENES)
    a = p.parse_args()
    rows = []
    for name in a.scenes:
        folder = os.path.join(a.datasets, name)
        points, box = truth_of(a.program, folder, name)
        for masks in ('auto', 'none'):
            found = inspect(a.program, folder, '--box', 'auto', '--masks', masks)
            got = np.array([found['box']['min'], found['box']['max']])
            rows.append({'scene': name, 'masks': masks, 'held': held_of(points, box, got),
                         'volume': float(np.prod(got[1] - got[0]) / np.prod(box[1] - box[0])),
                         'cpu': found['cpu'], 'wall': found['wall'], 'box': got.tolist(), 'source': found['box']['source']})
    print('| scene | masks | truth held | volume | CPU s | what it rests on |')
    print('|---' * 6 + '|')
    for r in rows:
        good = r['held'] >= LEAST_HELD and r['volume'] <= MOST_VOLUME
        print('| %s | %s | %.2f %% | %.2f%s | %.1f | %s |' % (r['scene'], r['masks'], 100 * r['held'], r['volume'], '' if good else ' (missed)',
                                                            r['cpu'], r['source']))
    if a.out:
        json.dump(rows, open(a.out, 'w'), indent=1)

if __name__ == '__main__':
    main()
