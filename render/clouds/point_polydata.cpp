#include "render/clouds/point_polydata.hpp"

#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <numeric>

namespace sweepscope {
namespace {

/// Three numbers for each point, side by side in memory.
template <typename Array, typename Number>
vtkSmartPointer<Array> triples(std::span<const std::array<Number, 3>> values) {
  auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size()));
  if (!values.empty()) std::copy_n(values.front().data(), 3 * values.size(), array->GetPointer(0));
  return array;
}

}  // namespace

vtkSmartPointer<vtkPolyData> to_polydata(std::span<const std::array<float, 3>> xyz_m,
                                         std::span<const std::array<std::uint8_t, 3>> rgb,
                                         std::span<const float> spacing_m) {
  const auto count = static_cast<vtkIdType>(xyz_m.size());
  vtkNew<vtkTypeInt64Array> offsets, connectivity;
  offsets->InsertNextValue(0);
  offsets->InsertNextValue(count);
  connectivity->SetNumberOfValues(count);
  std::iota(connectivity->GetPointer(0), connectivity->GetPointer(0) + count, vtkIdType{0});
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  vtkNew<vtkPoints> places;
  places->SetData(triples<vtkFloatArray>(xyz_m));
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(places);
  data->SetVerts(cells);
  data->GetPointData()->SetScalars(triples<vtkUnsignedCharArray>(rgb));
  if (!spacing_m.empty()) {
    vtkNew<vtkFloatArray> spacing;
    spacing->SetName(kSpacingArray);
    spacing->SetNumberOfValues(static_cast<vtkIdType>(spacing_m.size()));
    std::copy(spacing_m.begin(), spacing_m.end(), spacing->GetPointer(0));
    data->GetPointData()->AddArray(spacing);
  }
  return data;
}

}  // namespace sweepscope
