#!/usr/bin/python3
"""bench/refine_cameras.py [--program build/release/photohull] [--scenes block,pawn] [--noise 1,2] [--size 640x480]
    [--out bench/results/refine_cameras.json] [--keep FOLDER] [--no-surface]

What refined cameras are worth: synthesizes scenes of datasets/synthetic (or spec files by path) with poses put off by
so many pixels (root mean square over the object, each view by itself), refines them, and measures against the exact cameras
and the exact surface. Prints a table for docs/guide/cameras.md and keeps the figures as JSON. Columns:
  px      error of the cameras before and after: points of gt_visible.ply, as the exact cameras see them, are triangulated
          by the cameras in question; the similarity that brings them nearest to the exact points is taken off [Umeyama91];
          what is left is the distance in pixels between the projections by both, root mean square.
  world   the same without taking the similarity off: what the photographs cannot tell is in it.
  auto    whether 'reconstruct --refine-cameras auto' used the result (the row "0" is the clean scene, where it should not,
          or must not harm).
  F       at 0.25 % of the diagonal, of the surface that cameras see: exact cameras, noisy ones (off), and auto.
--no-surface leaves the reconstructions out. Needs numpy."""
import argparse, json, math, os, shutil, subprocess, sys, tempfile

import numpy as np

POINTS = 1000

def photohull(program, *arguments, as_json=True):
    run = subprocess.run([program, *arguments, *(['--json'] if as_json else [])], capture_output=True, text=True)
    if run.returncode not in (0, 3):  # 3: done, but the result failed its own checks
        raise SystemExit('%s failed (%d): %s' % (' '.join(arguments), run.returncode, run.stderr.strip()))
    return json.loads(run.stdout) if as_json else run.stdout

def cameras(folder):
    """Name to 3x4 matrix, pixel centre of the top-left pixel at (0, 0)."""
    with open(os.path.join(folder, 'transforms.json')) as f:
        scene = json.load(f)
    found = {}
    for frame in scene['frames']:
        get = lambda key: frame.get(key, scene.get(key))
        world = np.array(frame['transform_matrix'])
        world[:, 1:3] *= -1  # OpenGL's axes
        k = np.array([[get('fl_x'), 0, get('cx') - 0.5], [0, get('fl_y'), get('cy') - 0.5], [0, 0, 1]])
        found[os.path.basename(frame['file_path'])] = k @ np.linalg.inv(world)[:3]
    return found

def visible_points(path):
    """Points (x y z) and numbers of views of gt_visible.ply, thinned evenly."""
    with open(path, 'rb') as f:
        header, fields, count = f.readline(), [], 0
        kinds = {'float': 'f4', 'double': 'f8', 'uchar': 'u1', 'uint8': 'u1', 'int': 'i4', 'uint': 'u4', 'short': 'i2',
                 'ushort': 'u2', 'float32': 'f4', 'int32': 'i4', 'uint16': 'u2'}
        while header.strip() != b'end_header':
            words = header.decode().split()
            if words[:2] == ['element', 'vertex']:
                count = int(words[2])
            if words[:1] == ['property']:
                fields.append((words[2], '<' + kinds[words[1]]))
            header = f.readline()
        data = np.frombuffer(f.read(), dtype=np.dtype(fields), count=count)
    data = data[data['views'] >= 3]
    data = data[::max(1, len(data) // POINTS)]
    return np.stack([data['x'], data['y'], data['z']], 1).astype(float)

def project(p, x):
    h = x @ p[:, :3].T + p[:, 3]
    return h[:, :2] / h[:, 2:]

def triangulate(matrices, pixels):
    """Linear, each view's rows scaled by its depth, twice."""
    points = None
    for _ in range(3):
        a = []
        for p, u in zip(matrices, pixels):
            w = np.ones(len(u)) if points is None else 1 / (points @ p[2, :3] + p[2, 3])
            for i in range(2):
                a.append((u[:, i:i + 1] * p[2] - p[i]) * w[:, None])
        a = np.stack(a, 1)
        ata = a[:, :, :3].transpose(0, 2, 1) @ a[:, :, :3]
        atb = -(a[:, :, :3].transpose(0, 2, 1) @ a[:, :, 3:])
        points = np.linalg.solve(ata, atb)[:, :, 0]
    return points

def similarity(a, b):
    """Scale, rotation, shift that bring a nearest to b [Umeyama91]."""
    ma, mb = a.mean(0), b.mean(0)
    u, d, vt = np.linalg.svd((b - mb).T @ (a - ma) / len(a))
    s = np.diag([1, 1, np.sign(np.linalg.det(u @ vt))])
    r = u @ s @ vt
    c = np.trace(np.diag(d) @ s) / ((a - ma) ** 2).sum(1).mean()
    return c, r, mb - c * r @ ma

def camera_error(exact, other, points):
    names = sorted(exact)
    pixels = [project(exact[n], points) for n in names]
    c, r, t = similarity(points, triangulate([other[n] for n in names], pixels))
    rms = lambda where: math.sqrt(np.mean([((project(other[n], where) - u) ** 2).sum(1)
                                           for n, u in zip(names, pixels)]))
    return rms(c * points @ r.T + t), rms(points)

def synthesize(a, scene, noise, folder):
    path = scene if os.path.exists(scene) else os.path.join('datasets/synthetic', scene + '.json')
    with open(path) as f:
        spec = json.load(f)
    if noise > 0:
        spec.setdefault('degradations', {})['pose_error'] = noise
    out = os.path.join(folder, '%s_%g' % (spec['name'], noise))
    shutil.rmtree(out, ignore_errors=True)
    with open(out + '.json', 'w') as f:
        json.dump(spec, f)
    photohull(a.program, 'synthesize', out + '.json', '--out', out, '--size', a.size, as_json=False)
    return spec['name'], out

def f_score(a, scene, folder, refine):
    out = os.path.join(folder, os.path.basename(scene) + '_' + refine)
    report = photohull(a.program, 'reconstruct', scene, '--out', out, '--refine-cameras', refine)
    f = photohull(a.program, 'evaluate', os.path.join(out, 'mesh.ply'), '--truth', scene, '--thresholds', '0.0025')
    return 100 * f['seen']['f'][0]['f'], report

def judge(a, scene, noise, folder):
    name, path = synthesize(a, scene, noise, folder)
    exact_folder = os.path.join(path, 'true_cameras')
    exact = cameras(exact_folder if os.path.isdir(exact_folder) else path)
    points = visible_points(os.path.join(path, 'gt_visible.ply'))
    refined = path + '_refined'
    report = photohull(a.program, 'refine-cameras', path, '--out', refined, *a.options.split())
    row = {'scene': name, 'noise': noise, 'changed': report['changed'], 'tracks': report['tracks']}
    row['px'], row['world'] = (list(x) for x in zip(camera_error(exact, cameras(path), points),
                                                    camera_error(exact, cameras(refined), points)))
    if not a.no_surface:
        row['f_off'] = f_score(a, path, folder, 'off')[0]
        row['f'], report = f_score(a, path, folder, 'auto')
        row['used'] = report['camera_refinement']['used']
        row['cpu_s'] = report['cpu_seconds']
    return row

def table(rows):
    exact = {r['scene']: r.get('f_off') for r in rows if r['noise'] == 0}
    surface = any('f' in r for r in rows)
    print('| scene | noise, px | tracks | px before | px after | world before | world after |' +
          (' auto | F exact cameras | F off | F auto |' if surface else ''))
    print('|---' * (11 if surface else 7) + '|')
    number = lambda x: '%.2f' % x if x is not None else '-'
    for r in rows:
        print('| %s | %g | %d | %.3f | %.3f | %.3f | %.3f |' % (r['scene'], r['noise'], r['tracks'], *r['px'], *r['world']) +
              (' %s | %s | %s | %s |' % ('used' if r['used'] else 'not used', number(exact.get(r['scene'])),
                                         number(r['f_off']), number(r['f'])) if surface else ''))

def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument('--program', default='build/release/photohull')
    p.add_argument('--scenes', default='block,pawn')
    p.add_argument('--noise', default='0,1,2')
    p.add_argument('--size', default='640x480')
    p.add_argument('--out', default='bench/results/refine_cameras.json')
    p.add_argument('--keep', help='folder for scenes and meshes (default: they go)')
    p.add_argument('--no-surface', action='store_true')
    p.add_argument('--options', default='', help='further options of refine-cameras, for experiments')
    a = p.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = a.keep or scratch
        os.makedirs(folder, exist_ok=True)
        rows = []
        for scene in a.scenes.split(','):
            for noise in a.noise.split(','):
                rows.append(judge(a, scene, float(noise), folder))
                print(rows[-1], file=sys.stderr, flush=True)
    table(rows)
    os.makedirs(os.path.dirname(a.out) or '.', exist_ok=True)
    with open(a.out, 'w') as f:
        json.dump(rows, f, indent=1)

if __name__ == '__main__':
    main()
