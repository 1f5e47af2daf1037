#pragma once
#include "core/model/body_modes.hpp"
namespace tapstudy::core {
// Fills in what of a solved body can be touched: the upper face of a box, all of any other surface.
// Nodes are renumbered from 0.
void keep_touchable_part(const Shape& shape, SolvedBody& solved);
}  // namespace tapstudy::core
