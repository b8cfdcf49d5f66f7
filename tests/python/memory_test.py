"""Many reconstructions in one process: memory stays as it is, and no file is left open."""
import gc
import os

import photohull

RUNS = int(os.environ.get("PHOTOHULL_RUNS", "30"))
MOST_GROWTH = 24 << 20  # bytes; a result and its dense volume that were kept would be as much within a few runs


def resident():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def open_files():
    return len(os.listdir("/proc/self/fd"))


def threads():
    return len(os.listdir("/proc/self/task"))


def test_nothing_piles_up(arrays):
    scene = arrays.scene()

    def run():
        result = photohull.reconstruct(scene, method="hull", resolution=24, report_page="off")
        assert result.mesh.faces.size > 0 and result.volume.dense().size > 0
        result.measure()

    for _ in range(RUNS // 3):  # what is made once is made
        run()
    gc.collect()
    before, files, tasks = resident(), open_files(), threads()
    grown = []
    for _ in range(RUNS):
        run()
        grown.append(resident() - before)
    gc.collect()
    print(f"{RUNS} runs: resident memory {before >> 10} KiB, then {(resident() - before) >> 10:+} KiB, "
          f"at most {max(grown) >> 10:+} KiB; files {files} and {open_files()}; threads {tasks} and {threads()}")
    assert open_files() <= files
    assert threads() <= tasks
    assert resident() - before < MOST_GROWTH
