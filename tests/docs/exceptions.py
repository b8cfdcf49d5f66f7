"""Commands of the pages that are not run as they stand, and why. Each pattern has to match a command of some page."""

# Not run at all: what stands there is no whole command, or needs a program that may not be there.
FRAGMENTS = {
    r"photohull (pose|scan) (\.\./shared/|out/NAME)": "COLMAP may not be installed; tests/cli/pose_colmap_gl_test.cpp runs it where it is",
    r"photohull reconstruct \.\.\. ": "its arguments are left out",
}

# Started without the input that they ask for; they have to say so, and not that they are used wrongly.
WITHOUT_INPUT = {
    r"photohull calibrate \w+/": "there are no photographs of boards; tests/cli/calibrate_gl_test.cpp renders some",
    r"photohull (pose|scan) photos/": "there are no photographs; a rendered example follows it",
    r"photohull (pose|scan) --pass side1/": "there are no photographs; tests/cli/pose_passes_gl_test.cpp renders some",
    r"photohull batch rig/": "there are no frames; tests/cli/batch_gl_test.cpp makes some",
    r"photohull scan --video film": "there is no film; tests/cli/scan_gl_test.cpp makes one",
    r"photohull convert (rig|table|calib)\.json": "the same: these files come from calibrate",
}
