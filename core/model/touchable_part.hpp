#pragma once
#include "core/model/body_modes.hpp"
namespace tapstudy::core {
// Extracts the touchable part of a solved body: the upper face of a box, the entire surface of any
// other solid. Nodes are renumbered from 0.
void keep_touchable_part(const Shape& shape, SolvedBody& solved);
}  // namespace tapstudy::core
