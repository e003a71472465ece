# What every target of the project shares: include root, warnings, sanitizers.
function(lpf_configure_target target)
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow -Wconversion)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # g++ 12 warns of faults that are not there in inlined std::string and Eigen code.
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-maybe-uninitialized)
  endif()
  if(LPF_WERROR)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(NOT LPF_AVX512)
    target_compile_definitions(${target} PRIVATE LPF_NO_AVX512)
  endif()
  if(LPF_SANITIZE)
    target_compile_options(${target} PUBLIC -fsanitize=${LPF_SANITIZE} -fno-omit-frame-pointer
                                            -fno-sanitize-recover=all)
    target_link_options(${target} PUBLIC -fsanitize=${LPF_SANITIZE})
    # Run-time dispatch resolves before a sanitizer is up, so its builds use one instruction set.
    target_compile_definitions(${target} PRIVATE LPF_NO_MULTIVERSION LPF_SANITIZED)
  endif()
endfunction()

# lpf_add_library(name SOURCES ... DEPENDS ...): a static library of the project.
function(lpf_add_library target)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPENDS;PRIVATE_DEPENDS" ${ARGN})
  add_library(${target} STATIC ${ARG_SOURCES})
  target_link_libraries(${target} PUBLIC ${ARG_DEPENDS} PRIVATE ${ARG_PRIVATE_DEPENDS})
  lpf_configure_target(${target})
endfunction()
