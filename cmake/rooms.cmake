# A room is one library: src/<room>/*.cpp behind include/casepush/<room>/*.h.
#   casepush_room(cases SOURCES statistics.cpp ... ROOMS model PRIVATE SQLite::SQLite3 PUBLIC ...)
function(casepush_room name)
  cmake_parse_arguments(ARG "" "" "SOURCES;ROOMS;PUBLIC;PRIVATE" ${ARGN})
  add_library(casepush_${name} SHARED ${ARG_SOURCES})
  target_include_directories(casepush_${name} PUBLIC ${PROJECT_SOURCE_DIR}/include)
  list(TRANSFORM ARG_ROOMS PREPEND casepush_)
  target_link_libraries(casepush_${name} PUBLIC Eigen3::Eigen ${ARG_ROOMS} ${ARG_PUBLIC}
                        PRIVATE ${ARG_PRIVATE})
  target_compile_options(casepush_${name} PRIVATE ${CASEPUSH_WARNINGS})
  target_link_options(casepush_${name} PRIVATE -Wl,--no-undefined)
  install(TARGETS casepush_${name} LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION})
endfunction()

set(CASEPUSH_TEST_ENVIRONMENT
    "PATH=/usr/bin:$ENV{PATH};ROS_HOSTNAME=localhost;PYTHONNOUSERSITE=1;CASEPUSH_SHARE=${PROJECT_SOURCE_DIR}")

# One gtest program per test file: casepush_unit_test(cases/statistics_test.cpp ROOMS cases)
function(casepush_unit_test file)
  cmake_parse_arguments(ARG "" "TIMEOUT" "ROOMS;LIBRARIES" ${ARGN})
  if(NOT CATKIN_ENABLE_TESTING)
    return()
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  string(REGEX REPLACE "[/.]" "_" target "unit_${file}")
  string(REGEX REPLACE "_cpp$" "" target ${target})
  list(TRANSFORM ARG_ROOMS PREPEND casepush_)
  add_executable(${target} ${PROJECT_SOURCE_DIR}/test/unit/${file})
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/test/unit)
  target_compile_options(${target} PRIVATE ${CASEPUSH_WARNINGS})
  target_link_libraries(${target} ${ARG_ROOMS} ${ARG_LIBRARIES} GTest::gtest GTest::gtest_main)
  add_test(NAME unit/${file} COMMAND ${target})
  set_tests_properties(unit/${file} PROPERTIES TIMEOUT ${ARG_TIMEOUT}
                       ENVIRONMENT "${CASEPUSH_TEST_ENVIRONMENT}")
endfunction()

# casepush_ros_test(sim_node.test TIMEOUT 60): a rostest file under test/ros. Tests with the same LOCK never
# run at the same time.
function(casepush_ros_test file)
  cmake_parse_arguments(ARG "" "TIMEOUT;LOCK" "" ${ARGN})
  if(NOT CATKIN_ENABLE_TESTING)
    return()
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  add_test(NAME ros/${file}
           COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} ${casepush_ROSTEST}
                   --pkgdir=${PROJECT_SOURCE_DIR} --package=casepush
                   --results-filename ${file}.xml --results-base-dir ${PROJECT_BINARY_DIR}/test_results
                   ${PROJECT_SOURCE_DIR}/test/ros/${file})
  set_tests_properties(ros/${file} PROPERTIES TIMEOUT ${ARG_TIMEOUT} RESOURCE_LOCK "${ARG_LOCK}"
                       ENVIRONMENT "${CASEPUSH_TEST_ENVIRONMENT}")
endfunction()

# casepush_python_test(test_cli.py TIMEOUT 60): a pytest file under test/python.
function(casepush_python_test file)
  cmake_parse_arguments(ARG "" "TIMEOUT" "" ${ARGN})
  if(NOT CATKIN_ENABLE_TESTING)
    return()
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 120)
  endif()
  add_test(NAME python/${file}
           COMMAND ${CATKIN_ENV} ${PYTHON_EXECUTABLE} -m pytest -q -p no:cacheprovider
                   ${PROJECT_SOURCE_DIR}/test/python/${file})
  set_tests_properties(python/${file} PROPERTIES TIMEOUT ${ARG_TIMEOUT}
                       ENVIRONMENT "${CASEPUSH_TEST_ENVIRONMENT}")
endfunction()
