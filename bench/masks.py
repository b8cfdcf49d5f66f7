#!/usr/bin/python3
"""bench/masks.py [--program build/release/photohull] [--specs bench/specs/masks_*.json] [--out bench/results/masks.json] [--keep FOLDER]

Masks made from the background of rendered scenes, against the exact ones: by the background's colours and by
photographs without the object, each without and with GrabCut. Prints a table for docs/guide/masks.md: intersection over
union (the mean and the worst view), the share of the object that is missed, confidence (mean and least), and whether confidence tells the good masks
(IoU of 0.95 at least) from the bad ones: the chance that of two such masks the better one has more of it."""
import argparse, glob, json, os, subprocess, tempfile, time

GOOD = 0.95

def photohull(program, *arguments):
    run = subprocess.run([program, *arguments], capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit('%s failed (%d): %s' % (' '.join(arguments), run.returncode, run.stderr.strip()))
    return run.stdout

def mean(values):
    return sum(values) / len(values)

def main():
    p = argparse.ArgumentParser()
    p.add_argument('--program', default='build/release/photohull')
    p.add_argument('--specs', default=','.join(sorted(glob.glob('bench/specs/masks_*.json'))))
    p.add_argument('--out')
    p.add_argument('--keep')
    a = p.parse_args()
    rows, judged = [], []
    with tempfile.TemporaryDirectory() as scratch:
        folder = a.keep or scratch
        for spec in a.specs.split(','):
            name = os.path.splitext(os.path.basename(spec))[0]
            scene = os.path.join(folder, name)
            photohull(a.program, 'synthesize', spec, '--out', scene)
            truth = os.path.join(scene, 'masks')
            for label, more in (('colours', []), ('plates', ['--background', os.path.join(scene, 'plates')])):
                for cut in (False, True):
                    start = time.process_time(), os.times().children_user
                    found = json.loads(photohull(a.program, 'masks', scene, '--masks', 'background' if not more else 'auto', *more, '--compare', truth, '--json',
                                                 '--out', os.path.join(folder, '%s_%s%s' % (name, label, '_cut' if cut else '')), *(['--grabcut'] if cut else [])))
                    cpu = os.times().children_user - start[1]
                    views = [v for v in found['views'] if v['source'] != 'none']
                    if not cut:
                        judged += [(v['confidence'], v['iou']) for v in views]
                    rows.append({'scene': name, 'from': label, 'grabcut': cut, 'cpu': cpu, 'masks': len(views), 'views': found['views']})
    print('| scene | from | GrabCut | masks | IoU, mean (worst) | missed | confidence, mean (least) | CPU s |')
    print('|---' * 8 + '|')
    for r in rows:
        v = [x for x in r['views'] if x['source'] != 'none']
        print('| %s | %s | %s | %d of %d | %s | %.1f |' % (
            r['scene'], r['from'], 'yes' if r['grabcut'] else 'no', len(v), len(r['views']),
            '%.4f (%.4f) | %.2f %% | %.2f (%.2f)' % (mean([x['iou'] for x in v]), min(x['iou'] for x in v), 100 * mean([x['missed'] for x in v]),
                                                   mean([x['confidence'] for x in v]), min(x['confidence'] for x in v)) if v else '- | - | -', r['cpu']))
    good, bad = [c for c, i in judged if i >= GOOD], [c for c, i in judged if i < GOOD]
    if good and bad:
        print('%d good and %d bad masks; the good one has more confidence in %.3f of the pairs' % (
            len(good), len(bad), mean([(g > b) + 0.5 * (g == b) for g in good for b in bad])))
        for t in (0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9):
            print('below %.1f: %d of %d bad, %d of %d good' % (t, sum(c < t for c in bad), len(bad), sum(c < t for c in good), len(good)))
    if a.out:
        json.dump(rows, open(a.out, 'w'), indent=1)

main()
