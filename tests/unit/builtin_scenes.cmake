# The built-in scenes: counts, consistency, determinism, light placement.
add_executable(test_houses ${CMAKE_CURRENT_LIST_DIR}/test_houses.cpp)
umbrage_flags(test_houses)
target_link_libraries(test_houses PRIVATE app_scenes GTest::gtest_main)
gtest_discover_tests(test_houses)
