# Do messages of the libraries name options by option_word() (src/core/option_word.h) and not by flags
# of the command line? A test: cmake -DROOT=... -P CheckOptionWords.cmake. Fails where a string of a
# source file in src/ holds a word that begins with two dashes and a letter. Studies (src/lab) are the
# command line's own: what they run and say are its flags.
cmake_minimum_required(VERSION 3.25)

# Still to be reworded, as patterns of paths. Empty this list.
set(pending
  "src/pipeline/reconstruct[.]cpp"
  "src/pipeline/inputs[a-z_]*[.]cpp"
  "src/pipeline/[a-z_]*_stage[.]cpp")

file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/src/*.h ${ROOT}/src/*.cpp)
list(FILTER files EXCLUDE REGEX "^src/lab/")
set(faults)
foreach(file ${files})
  file(READ ${ROOT}/${file} text)
  string(REGEX REPLACE "//[^\n]*" "" text "${text}")
  string(REGEX MATCHALL "\"([^\"\n]*[^\"\nA-Za-z0-9_-])?--[a-z][^\"\n]*\"" found "${text}")
  set(waits FALSE)
  foreach(pattern ${pending})
    if(file MATCHES "^${pattern}$")
      set(waits TRUE)
    endif()
  endforeach()
  if(found AND NOT waits)
    list(APPEND faults "${file}: ${found}")
  endif()
endforeach()
if(faults)
  list(JOIN faults "\n" faults)
  message(FATAL_ERROR "These strings name flags of the command line; option_word() has the words:\n${faults}")
endif()
