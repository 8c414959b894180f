# SPDX-License-Identifier: MIT
include_guard(GLOBAL)
# Encoders for compressed fixtures: meshoptimizer's, of which core/lab compiles the simplifier alone; natively Draco's.
add_library(quadmark_test_encoders INTERFACE)
target_link_libraries(quadmark_test_encoders INTERFACE quadmark_meshoptimizer)
if(EXISTS ${QUADMARK_MESHOPTIMIZER_SOURCE}/src/vertexcodec.cpp)
  add_library(quadmark_meshopt_codec STATIC ${QUADMARK_MESHOPTIMIZER_SOURCE}/src/vertexcodec.cpp
                                            ${QUADMARK_MESHOPTIMIZER_SOURCE}/src/indexcodec.cpp)
  target_compile_options(quadmark_meshopt_codec PRIVATE -w)
  target_link_libraries(quadmark_test_encoders INTERFACE quadmark_meshopt_codec)
endif()
if(NOT EMSCRIPTEN)
  find_package(draco REQUIRED)
  target_link_libraries(quadmark_test_encoders INTERFACE draco::draco)
endif()
