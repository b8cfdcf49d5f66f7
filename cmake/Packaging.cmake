# What `cmake --install` puts where, and the Debian package of `cpack -G DEB`.
include(GNUInstallDirs)

if(TARGET photohull)
  install(TARGETS photohull photohull-main photohull-lab RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
# Manual pages and completions for bash, zsh and fish, which the programs tell.
find_package(Python3 3.10 QUIET COMPONENTS Interpreter)
if(TARGET photohull AND Python3_FOUND)
  install(CODE "execute_process(COMMAND \"${Python3_EXECUTABLE}\" \"${PROJECT_SOURCE_DIR}/scripts/make_manual.py\"
    \"${CMAKE_BINARY_DIR}/photohull\" \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\"
    COMMAND_ERROR_IS_FATAL ANY)")
endif()
install(FILES README.md CHANGELOG.md BIBLIOGRAPHY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
# The program holds a copy of ECharts (third_party/echarts): its licence and notices go along.
install(FILES third_party/echarts/LICENSE third_party/echarts/NOTICE
  third_party/echarts/licenses/LICENSE-d3 DESTINATION ${CMAKE_INSTALL_DOCDIR}/echarts)
# And of three.js (third_party/three).
install(FILES third_party/three/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR}/three)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME photohull)
set(CPACK_PACKAGE_VENDOR "The photohull authors")
set(CPACK_PACKAGE_CONTACT "The photohull authors")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGE_DESCRIPTION
"photohull reconstructs an object from photographs whose cameras are known: it carves away all
space that contradicts the silhouettes and the colours in the images, on the GPU or on Mesa's
software rasterizer, and writes an OpenVDB volume, a coloured mesh, a preview and a report.")
set(CPACK_STRIP_FILES ON)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SUGGESTS ffmpeg)  # writes films (io/ffmpeg.cpp)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Loaded at run time, where dpkg-shlibdeps cannot see it: an OpenGL driver behind EGL.
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libegl-mesa0, libgl1-mesa-dri")
include(CPack)
