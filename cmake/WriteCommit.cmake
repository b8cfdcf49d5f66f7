# Writes OUT, a header with the last commit of ROOT that changed what the program is built from, and
# "+changes" where the working tree is not that commit; "unknown" outside a clone. Leaves OUT alone
# where it says so already.
set(paths CMakeLists.txt cmake cli shaders src third_party)
execute_process(COMMAND git -C ${ROOT} log -1 --format=%H -- ${paths}
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(commit)
  execute_process(COMMAND git -C ${ROOT} status --porcelain -- ${paths} OUTPUT_VARIABLE changes ERROR_QUIET)
  if(changes)
    string(APPEND commit "+changes")
  endif()
else()
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#define PHOTOHULL_COMMIT \"${commit}\"\n")
