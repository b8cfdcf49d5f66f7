#!/usr/bin/python3
"""bench/photo_defaults.py [--program build/release/bench/carve_with] [--data ../shared] [--resolution 128]
                           [--scenes bunny,armadillo,fandisk,trellis] [--out bench/results/photo_defaults.json]

Space carving with each field of PhotoOptions halved, doubled or switched, one at a time, beside the defaults:
seen-surface F-score at 0.5 % of the diagonal per scene (DATA/tools/evaluate.py), their mean, and CPU seconds
relative to the defaults on the same scene."""
import argparse, json, os, subprocess, tempfile

VARIANTS = ['', 'keep_score=0.5', 'keep_score=0.7', 'better_by=0.05', 'better_by=0.3', 'min_views=2', 'min_views=4',
            'min_texture=0', 'min_texture=4', 'supersample=2', 'front_face=1', 'depth_bias=1.25', 'depth_bias=5',
            'max_path=16', 'max_path=256', 'max_rounds=1']

def main():
    p = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    p.add_argument('--program', default='build/release/bench/carve_with')
    p.add_argument('--data', default='../shared')
    p.add_argument('--resolution', type=int, default=128)
    p.add_argument('--scenes', default='bunny,armadillo,fandisk,trellis')
    p.add_argument('--out', default='bench/results/photo_defaults.json')
    a = p.parse_args()
    scenes = a.scenes.split(',')
    rows, base = [], None
    print('| change | ' + ' | '.join(scenes) + ' | mean | time |\n' + '|---' * (len(scenes) + 3) + '|')
    with tempfile.TemporaryDirectory() as folder:
        mesh, out = os.path.join(folder, 'm.ply'), os.path.join(folder, 'm.json')
        for variant in VARIANTS:
            f, seconds = [], []
            for scene in scenes:
                path = os.path.join(a.data, 'datasets', scene)
                seconds.append(float(subprocess.run([a.program, path, str(a.resolution), mesh] + variant.split(),
                                                    check=True, capture_output=True, text=True).stdout))
                subprocess.run(['/usr/bin/python3', os.path.join(a.data, 'tools/evaluate.py'), mesh, path, '--samples',
                                '100000', '--json', out], check=True, stdout=subprocess.DEVNULL)
                f.append(100 * json.load(open(out))['seen']['thresholds'][2]['f'])
            base = base or seconds
            ratio = sum(s / b for s, b in zip(seconds, base)) / len(scenes)
            rows.append({'change': variant or 'defaults', 'f05': dict(zip(scenes, f)), 'time_ratio': ratio})
            print('| %s | %s | %.2f | %.2f |' % (variant or 'defaults', ' | '.join('%.2f' % x for x in f), sum(f) / len(f), ratio), flush=True)
    os.makedirs(os.path.dirname(a.out) or '.', exist_ok=True)
    json.dump({'resolution': a.resolution, 'rows': rows}, open(a.out, 'w'), indent=1)

if __name__ == '__main__':
    main()
