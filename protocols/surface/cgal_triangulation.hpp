#pragma once
// CGAL's triangulations keep a map of 33 kB for each thread and each kind. What is thread-local of
// a program lies in every thread's stack (glibc), and those of the pages' server have 100 kB: with
// two such maps it cannot start one. Surfaces are mended in a process of one thread
// (surface_job.hpp), where a map for all threads does.
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Lazy.h>
#include <CGAL/Random.h>

#pragma push_macro("CGAL_STATIC_THREAD_LOCAL_VARIABLE_0")
#undef CGAL_STATIC_THREAD_LOCAL_VARIABLE_0
#define CGAL_STATIC_THREAD_LOCAL_VARIABLE_0(TYPE, VAR) static TYPE VAR
#include <CGAL/Triangulation_data_structure_3.h>
#pragma pop_macro("CGAL_STATIC_THREAD_LOCAL_VARIABLE_0")
