#pragma once
#include <string>

#include "core/model/body_modes.hpp"
namespace tapstudy::core {
// Writes the body with its mode shapes as a VTK unstructured grid (ParaView's .vtu, text): cells of
// 4 or 10 nodes, one vector per node and mode, named mode_1 …, scaled to a largest length of 1,
// and the natural frequencies [Hz] as field data.
// Why not VTK: its development package brings 200 others, for one text file of a format published
// whole (VTK File Formats, XML unstructured grid). meshio reads it back in the tests.
// Throws InvalidInput if the file exists already or cannot be written.
void write_vtu(const SolvedBody& body, const Eigen::ArrayXd& frequency_hz, const std::string& file);
}  // namespace tapstudy::core
