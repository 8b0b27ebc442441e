# What stores decide on the host, without a device.
add_executable(test_stores ${CMAKE_CURRENT_LIST_DIR}/test_map_images.cpp ${CMAKE_CURRENT_LIST_DIR}/test_page_residency.cpp)
umbrage_flags(test_stores)
target_link_libraries(test_stores PRIVATE umbrage_internals GTest::gtest_main)
gtest_discover_tests(test_stores)
