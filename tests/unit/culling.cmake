# Batches against receivers: the shaders' own code on the CPU.
add_executable(test_receivers ${CMAKE_CURRENT_LIST_DIR}/test_receivers.cpp)
umbrage_flags(test_receivers)
target_include_directories(test_receivers PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src)
target_link_libraries(test_receivers PRIVATE umbrage_reference_stages GTest::gtest_main)
gtest_discover_tests(test_receivers)
