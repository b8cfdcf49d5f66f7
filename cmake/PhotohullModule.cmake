# photohull_module(NAME SOURCES files... [PUBLIC libs...] [PRIVATE libs...])
# One static library per folder of src/. PRIVATE links keep a dependency's headers out of the
# modules above; the arrows are those of docs/architecture.md.
function(photohull_module name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(photohull_${name} STATIC ${ARG_SOURCES})
  add_library(photohull::${name} ALIAS photohull_${name})
  target_include_directories(photohull_${name} PUBLIC ${PROJECT_SOURCE_DIR}/src)
  target_compile_features(photohull_${name} PUBLIC cxx_std_20)
  target_compile_options(photohull_${name} PRIVATE ${PHOTOHULL_WARNINGS})
  target_link_libraries(photohull_${name} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE})
endfunction()

# photohull_test(NAME SOURCES files... LIBS libs... [LABELS labels...])
# One test program; every TEST becomes a ctest test of its own. Labels: unit, gl, golden, slow.
function(photohull_test name)
  cmake_parse_arguments(ARG "" "" "SOURCES;LIBS;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_compile_options(${name} PRIVATE ${PHOTOHULL_WARNINGS})
  target_compile_definitions(${name} PRIVATE
    PHOTOHULL_DATASETS="${PROJECT_SOURCE_DIR}/datasets"
    PHOTOHULL_TEST_DATA="${PROJECT_SOURCE_DIR}/tests/data")
  target_link_libraries(${name} PRIVATE ${ARG_LIBS} GTest::gtest_main GTest::gmock)
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT 600)
endfunction()
