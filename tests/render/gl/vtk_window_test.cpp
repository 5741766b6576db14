#include "render/gl/vtk_window.hpp"

#include <gtest/gtest.h>
#include <vtkActor.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkNew.h>
#include <vtkSetGet.h>

#include "render/pictures/picture.hpp"

namespace sweepscope {
namespace {

/// What is written to stderr meanwhile.
template <typename Work>
std::string said_on_stderr(const Work& work) {
  testing::internal::CaptureStderr();
  work();
  return testing::internal::GetCapturedStderr();
}

TEST(VtkMessages, StayOffStandardError) {
  const auto draw_and_complain = [] {
    Picture picture;
    picture.width_px = picture.height_px = 64;
    EXPECT_TRUE(draw(picture));
    vtkNew<vtkActor> actor;
    vtkGenericWarningMacro("a warning of no use to anyone");
    vtkErrorWithObjectMacro(actor.Get(), "what is wrong");
  };
  EXPECT_EQ(said_on_stderr(draw_and_complain), "");
}

TEST(VtkMessages, TheFirstErrorIsGivenWithoutItsAddressesOnce) {
  gl::quiet_vtk();
  (void)gl::take_vtk_error();
  vtkNew<vtkActor> actor;
  vtkErrorWithObjectMacro(actor.Get(), "what is wrong");
  vtkErrorWithObjectMacro(actor.Get(), "what follows from it");
  EXPECT_EQ(gl::take_vtk_error(), "what is wrong");
  EXPECT_EQ(gl::take_vtk_error(), "");
}

}  // namespace
}  // namespace sweepscope
