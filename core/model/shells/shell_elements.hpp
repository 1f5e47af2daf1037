#pragma once
#include "core/model/shape/shape.hpp"
namespace tapstudy::core {
// As an element's order: that of shells (shell_element.hpp), which no solid elements have.
inline constexpr int shell_order = 4;
// A plate that is this many times wider than thick may have shell elements, and has them on an
// automatic mesh; a sheet by its middle always does.
inline constexpr double least_width_to_thickness = 40.0;
bool is_sheet(const Shape& shape);
// The width of shells that leaves a sheet's triangles as they are; of a plate, half of its own.
double widest_shells_m(const Shape& shape);
}  // namespace tapstudy::core
