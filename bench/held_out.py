#!/usr/bin/python3
"""bench/held_out.py [--program build/release/photohull] [--data ../shared] [--scenes templeRing,dinoRing]
    [--out bench/results/held_out.json] [--keep FOLDER]

Judges reconstructions of photographs that have no true surface by photographs that were not used: holds out every
eighth view, reconstructs by each method, and predicts the held-out views from the mesh (photohull evaluate --photos), with
colours from all other views and with those at least 20 degrees away only, which is stricter. Prints tables for
docs/measurements/benchmarks.md; a ratio is that of the mean ZNCC to the hull's. Scenes that do have a true surface (gt.ply) get a row for that surface itself, which
no mesh should beat, and F-scores at 0.25 % beside the ZNCC. --keep leaves meshes and pictures of the worst
views in a folder."""
import argparse, json, os, subprocess, sys, tempfile

METHODS = ('hull', 'space-carving', 'refine', 'truth')
ANGLES = (0, 20)
STEP = 8

def photohull(program, *arguments):
    run = subprocess.run([program, *arguments, '--json'], capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit('%s failed (%d): %s' % (' '.join(arguments), run.returncode, run.stderr.strip()))
    return json.loads(run.stdout)

def judge(a, scene, method, folder):
    path = os.path.join(a.data, 'datasets', scene)
    truth = os.path.join(path, 'gt.ply')
    views = len(photohull(a.program, 'info', path)['views'])
    held_out = ','.join(str(i) for i in range(0, views, STEP))
    out = os.path.join(folder, '%s_%s' % (scene, method))
    row = {'scene': scene, 'method': method, 'held_out': held_out, 'angles': {}}
    if method == 'truth':
        if not os.path.isfile(truth):
            return None
        os.makedirs(out, exist_ok=True)
        mesh = truth
    else:
        report = photohull(a.program, 'reconstruct', path, '--out', out, '--method', method, '--resolution',
                           str(a.resolution), '--hold-out', held_out)
        row.update(resolution=a.resolution, cpu_s=report['cpu_seconds'], triangles=report['mesh']['triangles'])
        mesh = os.path.join(out, 'mesh.ply')
    def predicted(views, angle):
        return photohull(a.program, 'evaluate', mesh, '--photos', path, '--views', views, '--least-angle', str(angle),
                         '--picture', os.path.join(out, 'worst_%d.png' % angle))['photos']
    for angle in ANGLES:
        photos = predicted(held_out, angle)
        masked = [i for i, view in zip(held_out.split(','), photos['views']) if view['masked']]
        if 0 < len(masked) < len(photos['views']):  # without a mask, a whole photograph is foreground
            photos = predicted(','.join(masked), angle)
        row['angles'][str(angle)] = photos
    if os.path.isfile(truth):
        row['f'] = photohull(a.program, 'evaluate', mesh, '--truth', path, '--thresholds', '0.0025')['seen']['f'][0]['f']
    return row

def table(rows):
    hull = {r['scene']: r for r in rows if r['method'] == 'hull'}
    with_truth = any('f' in r for r in rows)
    print('| scene | method | CPU s | ZNCC | ratio | ZNCC from 20 degrees | ratio | PSNR, dB | covered % | excess % | IoU % | worst view |' +
          (' F 0.25 % |' if with_truth else ''))
    print('|---' * (13 if with_truth else 12) + '|')
    for r in rows:
        near, far = (r['angles'][str(a)]['all'] for a in ANGLES)
        base = [hull[r['scene']]['angles'][str(a)]['all']['zncc'] for a in ANGLES]
        print('| %s | %s | %s | %.3f | %.2f | %.3f | %.2f | %.2f | %.2f | %.2f | %.2f | %s |' % (
            r['scene'], r['method'], '%.1f' % r['cpu_s'] if 'cpu_s' in r else '-', near['zncc'], near['zncc'] / base[0], far['zncc'], far['zncc'] / base[1],
            near['psnr'], 100 * near['coverage'], 100 * near['excess'], 100 * near['silhouette_iou'],
            r['angles']['0']['worst']) + (' %.2f |' % (100 * r['f']) if 'f' in r else ' - |' if with_truth else ''))

def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument('--program', default='build/release/photohull')
    p.add_argument('--data', default='../shared')
    p.add_argument('--scenes', default='templeRing,dinoRing')
    p.add_argument('--resolution', type=int, default=256)
    p.add_argument('--out', default='bench/results/held_out.json')
    p.add_argument('--keep', help='folder for meshes and pictures (default: they go)')
    a = p.parse_args()
    if not os.path.isdir(os.path.join(a.data, 'datasets')):
        raise SystemExit(a.data + ': no datasets/ there; give --data')
    with tempfile.TemporaryDirectory() as scratch:
        folder = a.keep or scratch
        rows = []
        for scene in a.scenes.split(','):
            for method in METHODS:
                print(scene, method, file=sys.stderr, flush=True)
                row = judge(a, scene, method, folder)
                if row:
                    rows.append(row)
    table(rows)
    for r in rows:  # the scene's folder differs between machines
        for photos in r['angles'].values():
            photos['scene'] = r['scene']
    os.makedirs(os.path.dirname(a.out) or '.', exist_ok=True)
    with open(a.out, 'w') as f:
        json.dump(rows, f, indent=1)

if __name__ == '__main__':
    main()
