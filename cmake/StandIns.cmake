# OpenImageIO reads films by libraries that bring half of all that a program loads, among them those that talk to GPUs
# and to databases of maps. photohull opens no film with it (io/image_signature.h): its programs load stand-ins in the
# place of these libraries, whose functions fail, and start in half the time (decision 0027). The library and Python's
# module load none: other parts of their processes may want the films' readers.
include(GNUInstallDirs)

set(PHOTOHULL_STAND_INS ${PROJECT_BINARY_DIR}/stand_ins)
set(stand_ins)
get_target_property(reader OpenImageIO::OpenImageIO LOCATION)
execute_process(COMMAND ldd ${reader} OUTPUT_VARIABLE loaded ERROR_QUIET)
string(REPLACE "\n" ";" loaded "${loaded}")
foreach(line ${loaded})
  if(line MATCHES "^[ \t]*(lib(avcodec|avformat|avutil|swscale|opencv_videoio)\\.so[.0-9]*) => ([^ ]+)")
    set(library ${CMAKE_MATCH_3})
    set(stand_in ${PHOTOHULL_STAND_INS}/${CMAKE_MATCH_1})
    add_custom_command(OUTPUT ${stand_in}
      COMMAND ${CMAKE_COMMAND} -E make_directory ${PHOTOHULL_STAND_INS}
      COMMAND ${PROJECT_SOURCE_DIR}/scripts/make_stand_in.sh ${reader} ${library} ${stand_in}
      DEPENDS ${PROJECT_SOURCE_DIR}/scripts/make_stand_in.sh ${reader} ${library} VERBATIM)
    list(APPEND stand_ins ${stand_in})
  endif()
endforeach()
add_custom_target(photohull_stand_ins DEPENDS ${stand_ins})
install(FILES ${stand_ins} DESTINATION ${CMAKE_INSTALL_LIBDIR}/photohull COMPONENT photohull)

# photohull_load_stand_ins(NAME): the program, and all libraries that it loads, look for libraries among the stand-ins
# first. An RPATH does that; a RUNPATH would only hold for what the program itself names.
function(photohull_load_stand_ins name)
  add_dependencies(${name} photohull_stand_ins)
  target_link_options(${name} PRIVATE LINKER:--disable-new-dtags)
  set_target_properties(${name} PROPERTIES BUILD_RPATH ${PHOTOHULL_STAND_INS}
    INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/photohull")
endfunction()
