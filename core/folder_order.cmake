# prove_folder_order(LIBRARY FOLDER...): part of every build, it fails where a file includes one of a folder that is
# named after its own. So no two folders include each other. Files of the library's top folder include only each other.
function(prove_folder_order library)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp ${CMAKE_CURRENT_SOURCE_DIR}/*.hpp)
  set(proof ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/folder_order_proof.cmake)
  set(stamp ${CMAKE_CURRENT_BINARY_DIR}/folder_order.stamp)
  add_custom_command(
    OUTPUT ${stamp}
    COMMAND ${CMAKE_COMMAND} -DROOT=${PROJECT_SOURCE_DIR} -DLIBRARY=${library} "-DORDER=${ARGN}" -DSTAMP=${stamp}
            -P ${proof}
    DEPENDS ${files} ${proof} CMakeLists.txt
    COMMENT "Proving the order of the folders of ${library}" VERBATIM)
  add_custom_target(${library}_folder_order ALL DEPENDS ${stamp})
endfunction()
