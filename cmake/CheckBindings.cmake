# Are the bindings of kernels named? A test: cmake -DROOT=... -P CheckBindings.cmake. Fails where the
# host or a shader has a number in their place: the constants that both share stand in
# shaders/shared/. Fails as well where an algorithm includes a shader's header that a kernel's own
# wrapper should be the only one to know (src/carving, src/refine and src/visibility outside of
# kernels/). References may, and visibility's layout, which lays out what its shaders read.
cmake_minimum_required(VERSION 3.25)

set(faults)

# Adds a fault for each line of the files that matches.
function(find_faults pattern what)
  foreach(file ${ARGN})
    file(STRINGS ${ROOT}/${file} lines REGEX "${pattern}")
    foreach(line ${lines})
      string(STRIP "${line}" line)
      list(APPEND faults "${file}: ${what}: ${line}")
    endforeach()
  endforeach()
  set(faults ${faults} PARENT_SCOPE)
endfunction()

file(GLOB_RECURSE hosts RELATIVE ${ROOT} ${ROOT}/src/*.h ${ROOT}/src/*.cpp ${ROOT}/cli/*.cpp)
find_faults("[.>]bind(_[a-z]+)?\\([0-9]" "a number in place of a binding" ${hosts})
file(GLOB_RECURSE shaders RELATIVE ${ROOT} ${ROOT}/shaders/*.glsl)
find_faults("binding *= *[0-9]" "a number in place of a binding" ${shaders})
file(GLOB algorithms RELATIVE ${ROOT} ${ROOT}/src/carving/*.h ${ROOT}/src/carving/*.cpp
  ${ROOT}/src/refine/*.h ${ROOT}/src/refine/*.cpp
  ${ROOT}/src/visibility/*.h ${ROOT}/src/visibility/*.cpp)
list(FILTER algorithms EXCLUDE REGEX "_reference[.]|/visibility/layout[.]")
find_faults("#include \"shared/" "a shader's header outside of kernels/" ${algorithms})

if(faults)
  list(JOIN faults "\n  " faults)
  message(FATAL_ERROR "\n  ${faults}")
endif()
