# The built-in scenes: counts, consistency, determinism, light placement. One test, so that each scene is made once.
add_executable(test_builtin_scenes
  ${CMAKE_CURRENT_LIST_DIR}/builtin_scene.cpp ${CMAKE_CURRENT_LIST_DIR}/test_builtin_scenes.cpp
  ${CMAKE_CURRENT_LIST_DIR}/test_houses.cpp ${CMAKE_CURRENT_LIST_DIR}/test_landscape.cpp)
umbrage_flags(test_builtin_scenes)
target_link_libraries(test_builtin_scenes PRIVATE app_scenes GTest::gtest_main)
add_test(NAME BuiltinScenes COMMAND test_builtin_scenes)
