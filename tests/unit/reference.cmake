# The references themselves: ray tracer, metrics of `compare`, CPU versions of the stages.
add_executable(test_reference_tracer ${CMAKE_CURRENT_LIST_DIR}/test_reference_tracer.cpp)
target_compile_definitions(test_reference_tracer PRIVATE UMBRAGE_REFERENCE_MODULE="$<TARGET_FILE:umbrage_reference>")
target_link_libraries(test_reference_tracer PRIVATE umbrage_reference_loader app_import)

add_executable(test_reference_metrics ${CMAKE_CURRENT_LIST_DIR}/test_reference_metrics.cpp)
target_link_libraries(test_reference_metrics PRIVATE app_compare)

add_executable(test_reference_stages ${CMAKE_CURRENT_LIST_DIR}/test_reference_stages.cpp)

foreach(name test_reference_tracer test_reference_metrics test_reference_stages)
  umbrage_flags(${name})
  target_link_libraries(${name} PRIVATE umbrage_reference_stages GTest::gtest_main)
  gtest_discover_tests(${name})
endforeach()
