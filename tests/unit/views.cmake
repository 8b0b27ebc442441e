# Shadow view math, and the projection of boxes onto cube faces in C++ and GLSL.
foreach(name test_views test_cube_projection test_sun_levels)
  add_executable(${name} ${CMAKE_CURRENT_LIST_DIR}/${name}.cpp)
  umbrage_flags(${name})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${name} PRIVATE umbrage_views glm::glm GTest::gtest_main)
  gtest_discover_tests(${name})
endforeach()

add_test(NAME CubeProjection.GlslCompilesAlone
         COMMAND ${UMBRAGE_GLSLC} --target-env=vulkan1.3 -Werror -I ${PROJECT_BINARY_DIR}/include
                 -o ${CMAKE_CURRENT_BINARY_DIR}/cube_projection.spv ${CMAKE_CURRENT_LIST_DIR}/cube_projection.comp)
