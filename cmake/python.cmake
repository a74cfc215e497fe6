# A python3 without the ROS modules (pyenv, conda, a virtual environment) may come first on PATH.
# Finds one that imports them and makes every later find_package(Python...) use it.
function(casepush_find_ros_python)
  foreach(candidate ${PYTHON_EXECUTABLE} python3 /usr/bin/python3)
    execute_process(COMMAND ${candidate} -c "import catkin_pkg, em, genmsg"
                    RESULT_VARIABLE failed OUTPUT_QUIET ERROR_QUIET)
    if(failed EQUAL 0)
      find_program(found_python ${candidate} NO_CACHE)
      set(PYTHON_EXECUTABLE ${found_python} CACHE FILEPATH "Python with the ROS modules" FORCE)
      set(Python3_EXECUTABLE ${found_python} CACHE FILEPATH "Python with the ROS modules" FORCE)
      return()
    endif()
  endforeach()
  message(FATAL_ERROR "No python3 that imports catkin_pkg, em and genmsg was found. "
                      "Run `make deps`, or pass -DPYTHON_EXECUTABLE=<python3 of your ROS install>.")
endfunction()
