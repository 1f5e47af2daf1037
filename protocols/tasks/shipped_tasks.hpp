#pragma once
#include "protocols/tasks/task.hpp"
namespace tapstudy::protocols {
// One stimulus is presented; the answer names the stimulus it resembles (paper section 5.2.1).
const Task& identification();
// Several stimuli are switched between freely under blind labels; the answer is one of them (paper
// sections 5.2.2, 5.2.3).
const Task& choice();
}  // namespace tapstudy::protocols
