#!/usr/bin/python3
"""bench/photometric.py [--program build/release/photohull] [--specs bench/specs/jitter_folds.json,...]
    [--methods refine,hull] [--resolution 160] [--out bench/results/photometric.json] [--keep FOLDER]

What photographs of different exposure, white balance and vignetting cost, and what --photometric brings back. Each
spec is rendered as it is and without these degradations ("alike"); both are reconstructed with every eighth view
held out. Prints a table for docs/guide/cameras.md: F at 0.25 % of the diagonal, the error of the gains against
the synthesizer's true ones (up to a factor a channel), by how much the photographs disagree on the colour of a surface point, the error of predicted photographs (PSNR;
with the gains of all views measured on the mesh where --photometric is on), and the stage's CPU seconds."""
import argparse, json, math, os, subprocess, tempfile

STEP = 8
DEFAULT = 'bench/specs/jitter_folds.json,bench/specs/jitter_pawn.json,bench/specs/jitter_block.json'

def photohull(program, *arguments):
    run = subprocess.run([program, *arguments], capture_output=True, text=True)
    if run.returncode not in (0, 3):  # 3: done, but the result failed its own checks
        raise SystemExit('%s failed (%d): %s' % (' '.join(arguments), run.returncode, run.stderr.strip()))
    return run.stdout

def render(a, path, alike, folder):
    spec = json.load(open(path))
    if alike:
        for key in ('exposure', 'white_balance', 'vignetting'):
            spec['degradations'].pop(key, None)
    name = spec['name'] + ('_alike' if alike else '')
    file = os.path.join(folder, name + '.json')
    json.dump(spec, open(file, 'w'))
    scene = os.path.join(folder, name)
    photohull(a.program, 'synthesize', file, '--out', scene)
    return scene

def gain_errors(scene, photometric):
    result = json.load(open(os.path.join(scene, 'spec.json')))['result']
    true = dict(zip(result['views'], result['gains']))
    errors = []
    for channel in range(3):
        logs = [math.log(v['gain'][channel] / true[os.path.splitext(v['name'])[0] if v['name'] not in true else v['name']][channel])
                for v in photometric['views'] if v['solved']]
        middle = sum(logs) / len(logs)
        errors += [(e - middle) for e in logs]
    return {'rms': math.sqrt(sum(e * e for e in errors) / len(errors)), 'max': max(map(abs, errors))}

def measure(a, scene, label, method, photometric, folder):
    views = len(json.loads(photohull(a.program, 'info', scene, '--json'))['views'])
    held_out = ','.join(str(i) for i in range(0, views, STEP))
    out = os.path.join(folder, 'out_%s_%s_%s' % (os.path.basename(scene), method, photometric))
    report = json.loads(photohull(a.program, 'reconstruct', scene, '--out', out, '--method', method, '--resolution',
                                  str(a.resolution), '--hold-out', held_out, '--photometric', photometric, '--json'))
    mesh = os.path.join(out, 'mesh.ply')
    f = json.loads(photohull(a.program, 'evaluate', mesh, '--truth', scene, '--thresholds', '0.0025', '--json'))['seen']['f'][0]['f']
    photos = json.loads(photohull(a.program, 'evaluate', mesh, '--photos', scene, '--views', held_out,
                                  '--photometric', photometric, '--json'))['photos']['all']
    row = {'scene': label, 'method': method, 'photometric': photometric, 'f': f, 'psnr': photos['psnr'], 'zncc': photos['zncc']}
    p = report.get('photometric')
    if p:
        row.update(used=p['used'], before=p['disagreement_before'], after=p['disagreement_after'], lenses=p['lenses'],
                   cpu=sum(s['cpu_seconds'] for s in report['stages'] if s['name'] == 'photometric'))
        if p['solved']:
            row['gain_error'] = gain_errors(scene, p)
    return row

def main():
    p = argparse.ArgumentParser()
    p.add_argument('--program', default='build/release/photohull')
    p.add_argument('--specs', default=DEFAULT)
    p.add_argument('--methods', default='refine')
    p.add_argument('--resolution', type=int, default=160)
    p.add_argument('--out')
    p.add_argument('--keep')
    a = p.parse_args()
    rows = []
    with tempfile.TemporaryDirectory() as scratch:
        folder = a.keep or scratch
        os.makedirs(folder, exist_ok=True)
        for spec in a.specs.split(','):
            alike, jittered = render(a, spec, True, folder), render(a, spec, False, folder)
            name = os.path.basename(jittered)
            for method in a.methods.split(','):
                for scene, label, photometric in ((alike, name + ', alike', 'off'), (alike, name + ', alike', 'auto'),
                                                  (jittered, name, 'off'), (jittered, name, 'auto')):
                    rows.append(measure(a, scene, label, method, photometric, folder))
    print('| scene | method | --photometric | F 0.25 % | gain error rms (max) | colours differ | corrected | vignetting | PSNR, dB | CPU s |')
    print('|---' * 10 + '|')
    for r in rows:
        e = r.get('gain_error')
        print('| %s | %s | %s | %.2f | %s | %s | %s | %s | %.2f | %s |' % (
            r['scene'], r['method'], r['photometric'] + ('' if 'used' not in r else ' (corrects)' if r['used'] else ' (leaves)'),
            100 * r['f'], '%.2f %% (%.2f %%)' % (100 * e['rms'], 100 * e['max']) if e else '',
            '%.2f %%' % (100 * r['before']) if 'before' in r else '', '%.2f %%' % (100 * r['after']) if 'after' in r else '',
            ', '.join('%.3f +- %.3f' % (l['vignetting'], l['sigma']) for l in r['lenses']) if 'lenses' in r else '',
            r['psnr'], '%.1f' % r['cpu'] if 'cpu' in r else ''))
    if a.out:
        json.dump(rows, open(a.out, 'w'), indent=1)

main()
