# libphotohull.so: the modules that a reconstruction is made of, and those of synthetic scenes, for
# other programs (src/api) and for Python's package. It
# exports what is in namespace photohull; the libraries that it is linked with are its own matter.
# `cmake --install` puts it, its headers and photohullConfig.cmake into place.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(PHOTOHULL_LIBRARY_MODULES core share raycast gpu io io_mesh photo masks views cameras projtex visibility carving volume
  mesh texture eval assess sheet calib synth render refine page pipeline pose)
set(modules)
set(objects)
foreach(module ${PHOTOHULL_LIBRARY_MODULES})
  list(APPEND modules photohull_${module})
  list(APPEND objects $<TARGET_OBJECTS:photohull_${module}>)
endforeach()

# Of the modules' archives nothing is left to take: they bring the libraries that they are linked with.
add_library(photohull_shared SHARED ${objects})
set_target_properties(photohull_shared PROPERTIES
  OUTPUT_NAME photohull EXPORT_NAME photohull VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  LINK_DEPENDS ${PROJECT_SOURCE_DIR}/cmake/exported_symbols.txt)
target_compile_features(photohull_shared INTERFACE cxx_std_20)
target_include_directories(photohull_shared INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_options(photohull_shared PRIVATE -Wl,--version-script=${PROJECT_SOURCE_DIR}/cmake/exported_symbols.txt)
target_link_libraries(photohull_shared PRIVATE ${modules} INTERFACE glm::glm)
set_target_properties(photohull_shared PROPERTIES LINKER_LANGUAGE CXX)

install(TARGETS photohull_shared EXPORT photohull LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}
  COMPONENT runtime NAMELINK_COMPONENT dev)
install(EXPORT photohull NAMESPACE photohull:: FILE photohullTargets.cmake COMPONENT dev
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/photohull)
configure_package_config_file(cmake/photohullConfig.cmake.in ${PROJECT_BINARY_DIR}/photohullConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/photohull)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/photohullConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/photohullConfig.cmake ${PROJECT_BINARY_DIR}/photohullConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/photohull COMPONENT dev)
# The headers that photohull.h needs, whose include lines name the folder that they lie in then.
install(CODE "set(ROOT \"${PROJECT_SOURCE_DIR}/src\")
set(FOLDER \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}/photohull\")
include(\"${PROJECT_SOURCE_DIR}/cmake/InstallHeaders.cmake\")" COMPONENT dev)
