# Batches: the clustering and its bytes, what happens when memory runs out, and the program's cache of them.
set(prepare_meshes ${CMAKE_CURRENT_LIST_DIR}/prepare_meshes.cpp)
add_executable(test_prepare
  ${CMAKE_CURRENT_LIST_DIR}/test_prepare.cpp ${CMAKE_CURRENT_LIST_DIR}/test_prepare_clusters.cpp
  ${CMAKE_CURRENT_LIST_DIR}/test_prepared_bytes.cpp ${CMAKE_CURRENT_LIST_DIR}/prepare_reference.cpp ${prepare_meshes})
add_executable(test_prepare_memory ${CMAKE_CURRENT_LIST_DIR}/test_prepare_memory.cpp)
add_executable(test_batch_cache
  ${CMAKE_CURRENT_LIST_DIR}/test_batch_cache.cpp ${prepare_meshes})
target_link_libraries(test_batch_cache PRIVATE app_import)

foreach(name test_prepare test_prepare_memory test_batch_cache)
  umbrage_flags(${name})
  target_link_libraries(${name} PRIVATE umbrage_internals GTest::gtest_main)
  gtest_discover_tests(${name})
endforeach()
