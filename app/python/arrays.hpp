#pragma once

#include <pybind11/numpy.h>

#include <memory>
#include <utility>
#include <vector>

namespace sweepscope::python {

namespace py = pybind11;

/// A NumPy array over memory of the engine, without a copy: the array keeps `owner` alive by a capsule. It
/// cannot be written to, because what owns it may still compute with it. Strides are in bytes.
template <typename Scalar>
py::array view(const Scalar* first, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
               std::shared_ptr<const void> owner) {
  auto held = std::make_unique<std::shared_ptr<const void>>(std::move(owner));
  const py::capsule capsule(held.release(),
                            [](void* pointer) { delete static_cast<std::shared_ptr<const void>*>(pointer); });
  py::array array(py::dtype::of<Scalar>(), std::move(shape), std::move(strides), first, capsule);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// One member of every element of a vector: of the element's type, `count` numbers of it where there is more
/// than one.
template <typename Scalar, typename Element, typename Allocator, typename Member>
py::array column(const std::vector<Element, Allocator>& elements, const Member& first_of,
                 std::shared_ptr<const void> owner, py::ssize_t count = 1) {
  static const Element none{};
  const Scalar* first = first_of(elements.empty() ? none : elements.front());
  std::vector<py::ssize_t> shape{py::ssize_t(elements.size())}, strides{py::ssize_t(sizeof(Element))};
  if (count > 1) {
    shape.push_back(count);
    strides.push_back(py::ssize_t(sizeof(Scalar)));
  }
  return view(first, std::move(shape), std::move(strides), std::move(owner));
}

/// A whole vector of numbers.
template <typename Scalar>
py::array whole(const std::vector<Scalar>& numbers, std::shared_ptr<const void> owner) {
  return column<Scalar>(
      numbers, [](const Scalar& number) { return &number; }, std::move(owner));
}

}  // namespace sweepscope::python
