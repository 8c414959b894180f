# SPDX-License-Identifier: MIT
# Finds the toolchain file of whichever Emscripten is on PATH (Debian's package or an activated emsdk), so that
# `cmake --preset wasm` needs no wrapper command.
find_program(QUADMARK_EM_CONFIG em-config)
if(NOT QUADMARK_EM_CONFIG)
  message(FATAL_ERROR "em-config is not on PATH: run scripts/setup.sh or activate an emsdk (3.1.6 or later)")
endif()
execute_process(COMMAND ${QUADMARK_EM_CONFIG} EMSCRIPTEN_ROOT OUTPUT_VARIABLE emscripten_root
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
include(${emscripten_root}/cmake/Modules/Platform/Emscripten.cmake)
