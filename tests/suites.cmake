# Read by ctest: a test for each suite of `program`, a program of GoogleTest, named `library`.SUITE. A process for each
# test would spend more time on loading VTK, and on simulating what the tests of a suite share, than on the tests.
execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE listing RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  add_test(${library}.not_built ${program} --gtest_list_tests)
  return()
endif()
string(REGEX MATCHALL "(^|\n)[A-Za-z][^ \n]*\\." suites "${listing}")
foreach(suite ${suites})
  string(STRIP "${suite}" suite)
  string(REGEX REPLACE "\\.$" "" name "${suite}")
  add_test(${library}.${name} ${program} --gtest_filter=${suite}*)
  # Skipped is what skipped all of its tests: no line follows those of the skipped ones.
  set_tests_properties(${library}.${name} PROPERTIES TIMEOUT 900
    SKIP_REGULAR_EXPRESSION "PASSED  . 0 tests[.]\n([[]  SKIPPED [^\n]*\n)+$")
endforeach()
