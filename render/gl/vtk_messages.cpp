#include "render/gl/vtk_messages.hpp"

#include <vtkLogger.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <utility>

namespace sweepscope::gl {
namespace {

thread_local std::string first_error;

/// Of "ERROR: In FILE, line N\nvtkThing (0x55...): what is wrong\n\n" what is wrong: the rest differs from
/// run to run.
std::string without_place(std::string text) {
  if (const std::size_t at = text.find("): "); at != std::string::npos) text.erase(0, at + 3);
  text.erase(std::min(text.find('\n'), text.size()));
  return text;
}

/// What VTK would show its messages in.
class Messages final : public vtkOutputWindow {
 public:
  static Messages* New();
  vtkTypeMacro(Messages, vtkOutputWindow)

      void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (first_error.empty()) first_error = without_place(text);
  }
  void DisplayWarningText(const char*) override {}
  void DisplayGenericWarningText(const char*) override {}
  void DisplayDebugText(const char*) override {}
};

vtkStandardNewMacro(Messages);

bool begin() {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkOutputWindow::SetInstance(vtkSmartPointer<Messages>::New());
  return true;
}

}  // namespace

void quiet_vtk() {
  static const bool begun = begin();
  (void)begun;
}

std::string take_vtk_error() {
  return std::exchange(first_error, "");
}

}  // namespace sweepscope::gl
