// How far to go along a line that leads downhill on a convex function.

#ifndef INERTER_MUJOCO_DOWNHILL_H_
#define INERTER_MUJOCO_DOWNHILL_H_

// slope of the function at the part t of the line; it rises with t
typedef double (*DownhillSlope)(void* line, double t);

// The part of the line to go, in (0, 1], where the slope was asked for last: all of it unless the
// function rises again before, else about where the slope is 0. start: slope at 0, negative.
double downhill_search(DownhillSlope slope, void* line, double start);

#endif  // INERTER_MUJOCO_DOWNHILL_H_
