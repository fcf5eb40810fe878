// Constraint rows as functions of the acceleration: what forces they answer, and how stiffly.
//
//   f_c = -ds/dj,   j = J_c a - a_ref
//
// s the engine's cost of a row (documentation of MuJoCo, "Computation", primal problem): quadratic
// for an equality, Huber's for friction loss, one-sided for limits and pyramidal contacts, a cone
// for elliptic ones. s is convex, so that its Hessian has no negative eigenvalue.

#ifndef INERTER_MUJOCO_ROWS_H_
#define INERTER_MUJOCO_ROWS_H_

#include "mujoco/engine.h"

// most rows of one contact
enum { ROWS_OF_CONTACT = 6 };

typedef enum RowKind_ { ROW_EQUALITY, ROW_FRICTION, ROW_ONESIDED, ROW_CONE, ROW_OF_CONE } RowKind;

// rows with their columns numbered as the dofs of a part of the model
typedef struct Rows_ {
  int n;
  const int* row;  // place among the engine's rows
  RowKind* kind;   // ROW_CONE: the first of a contact, whose others are ROW_OF_CONE
  int* start;      // entries of row i: start[i] to start[i + 1]; those of a contact have the same
  int* column;     // places of later dofs come first: the numbers of a row fall
  mjtNum* value;
  mjtNum* stiffness;  // curvature of s while a row acts; 0: it does not
  mjtNum* cones;      // Hessian of a cone where its stiffness is negative, 36 numbers a row
} Rows;

// Rows row[0..n-1] of the engine; place[dof]: number of a dof, which falls as the dof rises. On the
// stack of mjData.
Rows rows_gather(const mjModel* m, mjData* d, int n, const int* row, const int* place);

// J_c a for an acceleration of the numbered dofs
void rows_multiply(const Rows* rows, const mjtNum* a, mjtNum* product);

// f_c at j; stiffness and cones of the rows become those at j
void rows_answer(const mjData* d, Rows* rows, const mjtNum* j, mjtNum* force);

// Add J_c' f to a vector of the numbered dofs.
void rows_add_force(const Rows* rows, const mjtNum* force, mjtNum* vector);

// Add J_c' S J_c to the lower half of a matrix (n x n), S the stiffness.
void rows_add_stiffness(const Rows* rows, int n, mjtNum* matrix);

// S u for a change u of j
void rows_stiffen(const Rows* rows, const mjtNum* u, mjtNum* force);

#endif  // INERTER_MUJOCO_ROWS_H_
