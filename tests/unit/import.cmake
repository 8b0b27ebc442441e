# Levels of detail that the program makes of meshes.
add_executable(test_detail_levels ${CMAKE_CURRENT_LIST_DIR}/test_detail_levels.cpp)
umbrage_flags(test_detail_levels)
target_link_libraries(test_detail_levels PRIVATE app_import GTest::gtest_main)
gtest_discover_tests(test_detail_levels)
