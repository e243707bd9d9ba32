# Writes OUT, a header with what `git describe` says of SOURCE; empty where that is no working copy. Run in every build.
execute_process(COMMAND git describe --always --dirty --tags WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
execute_process(COMMAND git rev-parse --show-toplevel WORKING_DIRECTORY ${SOURCE}
                OUTPUT_VARIABLE top OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
file(REAL_PATH ${SOURCE} source)
if(failed OR NOT top STREQUAL source)  # of a folder around this one
  set(described "")
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#pragma once\n\ninline constexpr const char* kGitDescribe = \"${described}\";\n")
