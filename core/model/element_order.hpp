#pragma once
namespace tapstudy::core {
// As Meshing::order: quadratic elements, or linear ones where quadratic ones would have more than
// max_chosen_dofs unknowns. Linear elements bend too stiffly: thin bodies of them have two to three
// times too high frequencies.
inline constexpr int chosen_order = 0;
// Unknowns up to which a model is made finer without being asked to: about 3 GB and a minute.
inline constexpr int max_chosen_dofs = 300000;
}  // namespace tapstudy::core
