# Writes OUTPUT with the commit of SOURCE_DIR, and what it was changed by since as a hash; leaves the
# file alone if nothing is new.
execute_process(COMMAND git rev-parse --short=12 HEAD WORKING_DIRECTORY ${SOURCE_DIR}
  OUTPUT_VARIABLE hash OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(hash "unknown")
else()
  execute_process(COMMAND git diff HEAD
    WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE changes ERROR_QUIET)
  if(changes)
    string(SHA256 changes_hash "${changes}")
    string(SUBSTRING ${changes_hash} 0 8 changes_hash)
    string(APPEND hash "+changes.${changes_hash}")
  endif()
endif()
set(text "#pragma once\n#define TAPSTUDY_GIT_HASH \"${hash}\"\n")
set(present "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} present)
endif()
if(NOT present STREQUAL text)
  file(WRITE ${OUTPUT} "${text}")
endif()
