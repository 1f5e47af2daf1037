#pragma once
#include "protocols/tasks/task.hpp"
namespace tapstudy::protocols {
// One stimulus is presented; the answer names the stimulus it resembles (paper section 5.2.1).
const Task& identification();
// Several stimuli are switched between freely under blind labels; the answer is one of them (paper
// sections 5.2.2, 5.2.3).
const Task& choice();
// Which of several is the comparison? m-alternative forced choice along an axis.
const Task& comparison();
const Task& same_different();
// Which of three or four differs? Triangle test, and oddity of four.
const Task& odd_one_out();
const Task& abx();
// Which of two to four is the sample?
const Task& match_to_sample();
// Which of two? All pairs of the stimuli.
const Task& paired();
// All of three to eight in order.
const Task& ranking();
// One stimulus, on a scale of steps.
const Task& rating();
// One stimulus, by a number; beside one whose number is told, or by itself.
const Task& magnitude();
// One stimulus is moved along an axis until it feels equal to a standard.
const Task& adjustment();
}  // namespace tapstudy::protocols
