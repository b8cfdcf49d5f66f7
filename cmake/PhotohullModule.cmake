# photohull_module(NAME [COLD] [FOLDERS names...] [SOURCES files...] [PUBLIC libs...]
#   [PRIVATE libs...])
# One static library per folder of src/: all .cpp files that lie there and in FOLDERS inside it, and
# SOURCES that the build makes. PRIVATE links keep a dependency's headers out of the
# modules above; the arrows are those of docs/design/architecture.md, and include lines keep to them
# (CheckIncludes.cmake). COLD: unit tests spend no time in it, so that it is
# compiled as PHOTOHULL_COLD_OPTIONS say: the sanitizers' build saves time by not optimizing it.
function(photohull_module name)
  cmake_parse_arguments(ARG "COLD" "" "FOLDERS;SOURCES;PUBLIC;PRIVATE" ${ARGN})
  list(TRANSFORM ARG_FOLDERS APPEND /*.cpp)
  file(GLOB files CONFIGURE_DEPENDS *.cpp ${ARG_FOLDERS})
  add_library(photohull_${name} STATIC ${files} ${ARG_SOURCES})
  add_library(photohull::${name} ALIAS photohull_${name})
  target_include_directories(photohull_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src)
  target_compile_features(photohull_${name} PUBLIC cxx_std_20)
  target_compile_options(photohull_${name} PRIVATE ${PHOTOHULL_WARNINGS})
  target_link_libraries(photohull_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
  set(owner photohull_core)
  if(ARG_COLD AND PHOTOHULL_COLD_OPTIONS)
    target_compile_options(photohull_${name} PRIVATE ${PHOTOHULL_COLD_OPTIONS})
    set(owner photohull_batch)  # the first of them: headers precompiled by other options do not fit
  endif()
  photohull_precompile(photohull_${name} ${owner}
    <algorithm> <filesystem> <functional> <glm/glm.hpp> <nlohmann/json.hpp> <span> <string> <vector>)
  photohull_uses(${name} ${ARG_PUBLIC} ${ARG_PRIVATE})
endfunction()

# photohull_uses(NAME libs...): notes that the sources in this folder may include headers of the
# modules among the libraries.
function(photohull_uses name)
  list(FILTER ARGN INCLUDE REGEX "^photohull::")
  list(TRANSFORM ARGN REPLACE "^photohull::" "")
  list(JOIN ARGN " " used)
  file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_SOURCE_DIR})
  set_property(GLOBAL APPEND_STRING PROPERTY PHOTOHULL_USES "${name} ${folder} ${used}\n")
endfunction()

# photohull_precompile(TARGET OWNER headers...): compiles the headers once, for OWNER, and all other
# targets take them from there. Only with PHOTOHULL_PRECOMPILE: the other builds notice headers that
# a file forgets to include.
function(photohull_precompile target owner)
  if(NOT PHOTOHULL_PRECOMPILE)
    return()
  endif()
  if(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
endfunction()

# photohull_test(NAME [HOT] SOURCES files... LIBS libs... [LABELS labels...] [SHARDS count])
# One test program. ctest runs it whole, or in SHARDS parts that may run side by side: loading the
# libraries takes a program half a second, which a process for every TEST would pay each time.
# HOT: it spends much time itself, so that it is optimized where cold modules are not.
# Labels: unit, gl, golden, slow. The target unit_tests builds those of the first, program_tests the
# others and the program.
function(photohull_test name)
  cmake_parse_arguments(ARG "HOT" "SHARDS" "SOURCES;LIBS;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_compile_options(${name} PRIVATE ${PHOTOHULL_TEST_OPTIONS})
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} GTest::gtest_main GTest::gmock)
  set(owner photohull_test_support)
  if(PHOTOHULL_COLD_OPTIONS AND NOT ARG_HOT)
    target_compile_options(${name} PRIVATE ${PHOTOHULL_COLD_OPTIONS})
    set(owner photohull_test_places)
  endif()
  photohull_precompile(${name} ${owner})
  if("unit" IN_LIST ARG_LABELS)
    add_dependencies(unit_tests ${name})
  else()
    add_dependencies(program_tests ${name})
  endif()
  if(NOT ARG_SHARDS)
    set(ARG_SHARDS 1)
  endif()
  foreach(shard RANGE 1 ${ARG_SHARDS})
    set(test ${name})
    if(ARG_SHARDS GREATER 1)
      string(APPEND test ".${shard}of${ARG_SHARDS}")
    endif()
    math(EXPR index "${shard} - 1")
    add_test(NAME ${test} COMMAND ${name} --gtest_brief=1)
    # Shards are the long ones: they start first.
    set_tests_properties(${test} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 1200 COST ${ARG_SHARDS}
      ENVIRONMENT "GTEST_TOTAL_SHARDS=${ARG_SHARDS};GTEST_SHARD_INDEX=${index}")
  endforeach()
endfunction()
