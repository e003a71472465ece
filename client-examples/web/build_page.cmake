# cmake -DNPM= -DSOURCE= -DWORK= -DOUTPUT= -P build_page.cmake: builds the page in a copy of its
# sources, so that the source tree stays as it is.
file(MAKE_DIRECTORY "${WORK}")
set(stamp "${WORK}/installed")
set(lock_hash "")
set(installed_hash "")
file(SHA256 "${SOURCE}/package-lock.json" lock_hash)
if(EXISTS "${stamp}")
  file(READ "${stamp}" installed_hash)
endif()

file(REMOVE_RECURSE "${WORK}/src" "${WORK}/public")
foreach(name src public index.html package.json package-lock.json vite.config.js .npmrc)
  file(COPY "${SOURCE}/${name}" DESTINATION "${WORK}")
endforeach()

function(run_npm)
  execute_process(COMMAND "${NPM}" ${ARGN} WORKING_DIRECTORY "${WORK}" RESULT_VARIABLE result
                  OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(WARNING "npm ${command} failed, so there is no new web page; the server itself is "
                    "complete.\n${output}")
    set(failed TRUE PARENT_SCOPE)
  endif()
endfunction()

set(failed FALSE)
if(NOT lock_hash STREQUAL installed_hash)
  run_npm(ci)
  if(NOT failed)
    file(WRITE "${stamp}" "${lock_hash}")
  endif()
endif()
if(NOT failed)
  run_npm(run build -- --outDir "${OUTPUT}" --emptyOutDir)
endif()
