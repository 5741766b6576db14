# Seconds of the tests that take longest: they start first, so that no processor is idle at the end. Of ctest's own record:
#   sort -rnk3 build/Testing/Temporary/CTestCostData.txt | head -40
# Those with a window or a browser run one after the other: their chain begins at once.
set(costs
    serve.browser 400 page.browser 390 ui.window 380 ui.journey.choices 370 ui.journey.keyboard 360 ui.journey.handle 350
    app.ros 340 serve.proxy 330 screenshot.prepare 320
    core.GivenPoses 132 ui.Headless 132 core.InterruptedWork 122 core.Estimate 105 app.OfEveryCommand/OutputsOntoInputs 98
    ui.Played 86 python.numbers 79 core.InterruptedEstimate 73 package.installed 69 app.OfEveryCommand/Outputs 59
    core.ScanSize 53 app.ReportCommand 45 app.Choices 43 python.wheel 42)
while(costs)
  list(POP_FRONT costs test seconds)
  set_tests_properties(${test} PROPERTIES COST ${seconds})
endwhile()
