# Do messages of the libraries name options by option_word() (src/core/option_word.h) and not by flags
# of the command line? A test: cmake -DROOT=... -P CheckOptionWords.cmake. Fails where a string of a
# source file in src/ holds a word that begins with two dashes and a letter. Studies (src/lab) are the
# command line's own: what they run and say are its flags. COLMAP's flags are COLMAP's, and those
# of programs that run many processes are theirs.
cmake_minimum_required(VERSION 3.25)

file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/src/*.h ${ROOT}/src/*.cpp)
list(FILTER files EXCLUDE REGEX "^src/(lab/|io/run_colmap\\.cpp$|batch/engine\\.cpp$)")
set(faults)
foreach(file ${files})
  file(READ ${ROOT}/${file} text)
  string(REGEX REPLACE "//[^\n]*" "" text "${text}")
  string(REGEX MATCHALL "\"([^\"\n]*[^\"\nA-Za-z0-9_-])?--[a-z][^\"\n]*\"" found "${text}")
  if(found)
    list(APPEND faults "${file}: ${found}")
  endif()
endforeach()
if(faults)
  list(JOIN faults "\n" faults)
  message(FATAL_ERROR "These strings name flags of the command line; option_word() has the words:\n${faults}")
endif()
