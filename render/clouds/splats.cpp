#include "render/clouds/splats.hpp"

#include <vtk_glew.h>

#include <vtkActor.h>
#include <vtkDataObject.h>
#include <vtkPolyDataMapper.h>
#include <vtkShaderProperty.h>
#include <vtkUniforms.h>

#include "render/clouds/point_polydata.hpp"

namespace sweepscope {

void add_splats(vtkActor& actor, vtkPolyDataMapper& mapper) {
  mapper.MapDataArrayToVertexAttribute("pointSpacing", kSpacingArray,
                                       vtkDataObject::FIELD_ASSOCIATION_POINTS);
  vtkShaderProperty& shader = *actor.GetShaderProperty();
  shader.AddVertexShaderReplacement("//VTK::PositionVC::Dec", true,
                                    "//VTK::PositionVC::Dec\nin float pointSpacing;\n", false);
  // gl_Position.w is the distance from a perspective camera, and 1 in a parallel projection.
  shader.AddVertexShaderReplacement(
      "//VTK::PositionVC::Impl", true,
      "//VTK::PositionVC::Impl\n"
      "  gl_PointSize = clamp(floor(splatScale * pointSpacing / gl_Position.w + 0.5), splatMin, splatMax);\n",
      false);
  set_splat_sizes(actor, {});
}

void set_splat_sizes(vtkActor& actor, const SplatSizes& sizes) {
  vtkUniforms& uniforms = *actor.GetShaderProperty()->GetVertexCustomUniforms();
  uniforms.SetUniformf("splatScale", static_cast<float>(sizes.px_per_m));
  uniforms.SetUniformf("splatMin", static_cast<float>(sizes.min_px));
  uniforms.SetUniformf("splatMax", static_cast<float>(sizes.max_px));
}

SplatsOn::SplatsOn(bool on) : on_(on) {
  if (on_) glEnable(GL_PROGRAM_POINT_SIZE);
}

SplatsOn::~SplatsOn() {
  if (on_) glDisable(GL_PROGRAM_POINT_SIZE);
}

}  // namespace sweepscope
