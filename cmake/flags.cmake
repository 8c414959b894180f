# SPDX-License-Identifier: MIT
# Our own compile flags. Everything that decides bits must round alike natively and in wasm, hence -ffp-contract=off,
# and never fast-math or -march.
add_library(quadmark_flags INTERFACE)
target_compile_options(quadmark_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion
                                                -ffp-contract=off -fno-fast-math
                                                # Change no value, only errno and signals, and let loops vectorise.
                                                -fno-math-errno -fno-trapping-math)
if(QUADMARK_SANITIZE)
  target_compile_options(quadmark_flags INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=all
                                                  -fno-omit-frame-pointer)
  target_link_options(quadmark_flags INTERFACE -fsanitize=address,undefined)
endif()
if(QUADMARK_BUILD_FUZZERS)
  # Conversions of numbers that do not fit differ between platforms; clang checks them only when asked.
  target_compile_options(quadmark_flags INTERFACE -fsanitize=fuzzer-no-link,float-cast-overflow)
endif()
if(EMSCRIPTEN)
  target_compile_options(quadmark_flags INTERFACE -msimd128 -mnontrapping-fptoint -msign-ext)
endif()

# Rebuilding is most of the waiting time; ccache does not know em++, hence natively only.
find_program(QUADMARK_CCACHE ccache)
if(QUADMARK_CCACHE AND NOT EMSCRIPTEN AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${QUADMARK_CCACHE})
endif()
