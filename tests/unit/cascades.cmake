# Cascades without a device: volumes and how they move, and the shaders' own set tests against the listings.
add_executable(test_cascades ${CMAKE_CURRENT_LIST_DIR}/test_cascade_volumes.cpp ${CMAKE_CURRENT_LIST_DIR}/test_cascade_sets.cpp)
umbrage_flags(test_cascades)
target_link_libraries(test_cascades PRIVATE umbrage_internals umbrage_reference_stages GTest::gtest_main)
gtest_discover_tests(test_cascades)
