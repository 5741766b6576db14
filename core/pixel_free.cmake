# The proof that the engine knows no pixels: no source of core reaches a header of VTK, OpenGL, Dear ImGui or GLFW,
# and a program that holds all of core loads no library of theirs. Part of every build.
set(probe_source ${CMAKE_CURRENT_BINARY_DIR}/pixel_free_probe.cpp)
file(WRITE ${probe_source} "int main() {}\n")
add_executable(core_pixel_free_probe ${probe_source})
target_link_libraries(core_pixel_free_probe PRIVATE -Wl,--no-as-needed -Wl,--whole-archive sweepscope_core
                      -Wl,--no-whole-archive)
set(include_flags $<TARGET_PROPERTY:sweepscope_core,INCLUDE_DIRECTORIES>)
add_custom_command(
  OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/pixel_free.stamp
  COMMAND ${CMAKE_COMMAND} -DCOMPILER=${CMAKE_CXX_COMPILER} "-DINCLUDES=${include_flags}"
          -DPROBE=$<TARGET_FILE:core_pixel_free_probe> -DROOT=${PROJECT_SOURCE_DIR}
          -DSTAMP=${CMAKE_CURRENT_BINARY_DIR}/pixel_free.stamp -P ${CMAKE_CURRENT_SOURCE_DIR}/pixel_free_proof.cmake
  DEPENDS core_pixel_free_probe ${core_sources} pixel_free_proof.cmake
  COMMENT "Proving that core reaches no pixels" VERBATIM)
add_custom_target(core_pixel_free ALL DEPENDS ${CMAKE_CURRENT_BINARY_DIR}/pixel_free.stamp)
