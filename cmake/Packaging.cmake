# What `cmake --install` puts where, and the Debian packages of `cpack -G DEB`: one for each of the components photohull
# (programs, manual, demo), runtime (libphotohull.so), dev (headers) and python.
include(GNUInstallDirs)

if(TARGET photohull)
  install(TARGETS photohull photohull-main photohull-lab RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT photohull)
endif()
# Manual pages and completions for bash, zsh and fish, which the programs tell.
find_package(Python3 3.10 QUIET COMPONENTS Interpreter)
if(TARGET photohull AND Python3_FOUND)
  install(CODE "execute_process(COMMAND \"${Python3_EXECUTABLE}\" \"${PROJECT_SOURCE_DIR}/scripts/make_manual.py\"
    \"${CMAKE_BINARY_DIR}/photohull\" \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\"
    COMMAND_ERROR_IS_FATAL ANY)
    file(GLOB pages \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}/man/man1/photohull*.1\")
    execute_process(COMMAND gzip -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)" COMPONENT photohull)
endif()
install(FILES README.md BIBLIOGRAPHY.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT photohull)
# The program holds a copy of ECharts (third_party/echarts): its licence and notices go along.
install(FILES third_party/echarts/LICENSE third_party/echarts/NOTICE
  third_party/echarts/licenses/LICENSE-d3 DESTINATION ${CMAKE_INSTALL_DOCDIR}/echarts COMPONENT photohull)
# And of three.js (third_party/three).
install(FILES third_party/three/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR}/three COMPONENT photohull)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT photohull)
# The add-on for Blender.
install(FILES python/blender/photohull_import.py DESTINATION ${CMAKE_INSTALL_DATADIR}/photohull/blender COMPONENT photohull)
# What `photohull demo` reconstructs.
install(DIRECTORY datasets/templeSparseRing DESTINATION ${CMAKE_INSTALL_DATADIR}/photohull COMPONENT photohull)

# All of this without the tests.
add_custom_target(installed DEPENDS photohull_shared)
foreach(target photohull photohull-lab photohull_python)
  if(TARGET ${target})
    add_dependencies(installed ${target})
  endif()
endforeach()

set(CPACK_THREADS 0)  # all
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME photohull)
set(CPACK_PACKAGE_VENDOR "The photohull authors")
set(PHOTOHULL_CONTACT "The photohull authors <photohull@packages.invalid>" CACHE STRING "Maintainer of the Debian packages")
set(CPACK_PACKAGE_CONTACT "${PHOTOHULL_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)

set(CPACK_COMPONENTS_ALL photohull runtime dev)
if(TARGET photohull_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${CMAKE_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)

set(runtime_package libphotohull${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
# Loaded at run time, where dpkg-shlibdeps cannot see it: an OpenGL driver behind EGL.
set(driver "libegl-mesa0, libgl1-mesa-dri")
set(what "It carves away all space that contradicts
the silhouettes and the colours in photographs whose cameras are known, on
the GPU or on Mesa's software rasterizer.")

set(CPACK_DEBIAN_PHOTOHULL_PACKAGE_NAME photohull)
set(CPACK_DEBIAN_PHOTOHULL_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PHOTOHULL_PACKAGE_DEPENDS ${driver})
set(CPACK_DEBIAN_PHOTOHULL_PACKAGE_SUGGESTS "ffmpeg, colmap, python3-photohull")  # films (io/ffmpeg.cpp), cameras
set(CPACK_DEBIAN_PHOTOHULL_DESCRIPTION "solid 3D models from photographs by space carving
photohull turns photographs of an object into an OpenVDB volume, a coloured
mesh, a preview and a report. ${what}")

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME ${runtime_package})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS ${driver})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${CMAKE_BINARY_DIR}/debian/triggers)
file(WRITE ${CMAKE_BINARY_DIR}/debian/triggers "activate-noawait ldconfig\n")
set(CPACK_DEBIAN_RUNTIME_DESCRIPTION "space carving of photographs (library)
libphotohull turns photographs in memory or in files into volumes and meshes.
${what}
.
This package holds the shared library.")

set(CPACK_DEBIAN_DEV_PACKAGE_NAME libphotohull-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "${runtime_package} (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), libglm-dev")
set(CPACK_DEBIAN_DEV_DESCRIPTION "space carving of photographs (development files)
libphotohull turns photographs in memory or in files into volumes and meshes.
${what}
.
This package holds the headers and the CMake package.")

set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-photohull)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
# The extension is of one version of Python; what comes after it may differ.
if(TARGET photohull_python)
  get_property(python_minor GLOBAL PROPERTY PHOTOHULL_PYTHON_MINOR)
  math(EXPR next_python "${python_minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "${runtime_package} (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}), \
python3 (>= 3.${python_minor}~), python3 (<< 3.${next_python}), python3-numpy")
endif()
set(CPACK_DEBIAN_PYTHON_DESCRIPTION "space carving of photographs (Python 3)
import photohull makes volumes and meshes of photographs, from files or from
NumPy arrays, and measures them. ${what}")

# Debian's policy: each package has its copyright and changelog in a folder of its name.
execute_process(COMMAND git log -1 --format=%cD WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
  OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT date)
  string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)
endif()
set(changelog ${CMAKE_BINARY_DIR}/debian/changelog.Debian)
file(WRITE ${changelog} "photohull (${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE}) unstable; urgency=medium

  * CHANGELOG.md tells what changed.

 -- ${CPACK_PACKAGE_CONTACT}  ${date}
")
execute_process(COMMAND gzip -9nf ${changelog})
foreach(component ${CPACK_COMPONENTS_ALL})
  string(TOUPPER ${component} upper)
  set(package ${CPACK_DEBIAN_${upper}_PACKAGE_NAME})
  set(documents ${CMAKE_INSTALL_DATADIR}/doc/${package})
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/debian_copyright.txt DESTINATION ${documents} RENAME copyright COMPONENT ${component})
  install(FILES CHANGELOG.md ${changelog}.gz DESTINATION ${documents} COMPONENT ${component})
endforeach()
include(CPack)
