# SPDX-License-Identifier: MIT
# Third-party code comes from the system's packages (scripts/setup.sh). Header-only libraries are copied into the build
# tree one by one: pointing Emscripten at /usr/include would mix in the host's C library.
find_package(Eigen3 3.4 REQUIRED NO_MODULE NO_CMAKE_FIND_ROOT_PATH)

set(third_party ${CMAKE_BINARY_DIR}/third_party)
function(quadmark_copy_header header destination)
  find_file(found_${destination} NAMES ${header} PATHS /usr/include /usr/local/include NO_CMAKE_FIND_ROOT_PATH NO_CACHE)
  if(NOT found_${destination})
    message(FATAL_ERROR "${header} not found: run scripts/setup.sh")
  endif()
  if(IS_DIRECTORY ${found_${destination}})
    file(COPY ${found_${destination}}/ DESTINATION ${third_party}/${destination})
  else()
    configure_file(${found_${destination}} ${third_party}/${destination} COPYONLY)
  endif()
endfunction()

quadmark_copy_header(nlohmann nlohmann)
quadmark_copy_header(stb/stb_image.h stb_image.h)
quadmark_copy_header(stb/stb_image_write.h stb_image_write.h)

add_library(quadmark_third_party INTERFACE)
target_include_directories(quadmark_third_party SYSTEM INTERFACE ${third_party})
target_link_libraries(quadmark_third_party INTERFACE Eigen3::Eigen)

# meshoptimizer's sources, unpacked by scripts/setup.sh: one version for native and wasm gives equal bits.
set(QUADMARK_MESHOPTIMIZER_SOURCE "${PROJECT_SOURCE_DIR}/build/deps/meshoptimizer" CACHE PATH
    "Unpacked meshoptimizer source; without it the native build uses the system's library")
