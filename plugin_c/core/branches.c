// Viscoelastic branches between the terminals: Maxwell elements, a spring and a dashpot in series.
//
//   e_i' = v - K_i e_i / C_i,   F = sum of K_i e_i
//
// e_i [m] deflection of spring i, K_i [N/m] branch_stiffness_i, C_i [N s/m] branch_damping_i; up to
// three, numbered without a gap. With `stiffness` beside them a generalised Maxwell (Wiechert)
// body. Positive force lengthens. Stored energy: sum of K_i e_i^2 / 2; heat: sum of (K_i e_i)^2 /
// C_i. Complex stiffness: sum of K_i i w tau_i / (1 + i w tau_i), tau_i = C_i / K_i. Exact at
// constant v: e decays towards v tau_i. Source: linear viscoelasticity, e.g. Ferry 1980; rubber
// mounts and seals. Not modelled: dependence on amplitude (Payne effect: see maxwell_slip.c) and on
// temperature.

#include "elementary.h"
#include "laws.h"

int branch_count(const InerterDevice* p) {
  int count = 0;
  while (count < INERTER_MAXBRANCH && branch_element(p, count)[0] > 0) {
    count++;
  }
  return count;
}

void branches_rate(const InerterDevice* p, double v, const double* e, double* rate) {
  for (int i = 0; i < p->nbranch; i++) {
    const double* branch = branch_element(p, i);
    rate[i] = v - branch[0] * e[i] / branch[1];
  }
}

void branches_step(const InerterDevice* p, double v, double* e, double h) {
  for (int i = 0; i < p->nbranch; i++) {
    const double* branch = branch_element(p, i);
    double time = branch[1] / branch[0];
    e[i] += branch_share(time, h) * (v * time - e[i]);
  }
}

// along a motion
void branches_follow(const InerterDevice* p, const Way* way, double* e, double h) {
  const double rates[RESPONSES] = {way->v, way->a, way->jerk, way->snap, way->crackle};
  for (int i = 0; i < p->nbranch; i++) {
    const double* branch = branch_element(p, i);
    double driven[RESPONSES], rate = branch[0] / branch[1];
    decay_driven(rate, h, driven);
    e[i] *= elementary_exp(-rate * h);
    for (int k = 0; k < RESPONSES; k++) {
      e[i] += driven[k] * rates[k];
    }
  }
}

double branches_force(const InerterDevice* p, const double* e) {
  double sum = 0;
  for (int i = 0; i < p->nbranch; i++) {
    sum += branch_element(p, i)[0] * e[i];
  }
  return sum;
}

double branches_over_step(const InerterDevice* p, double v1, double* e, double h, double mobility) {
  double sum = 0;
  for (int i = 0; i < p->nbranch; i++) {
    sum += branch_element(p, i)[0];
  }
  double share = least_share(sum, mobility, h), before = branches_force(p, e);
  branches_step(p, v1, e, h);
  return before + share * (branches_force(p, e) - before);
}

double branches_energy(const InerterDevice* p, const double* e) {
  double sum = 0;
  for (int i = 0; i < p->nbranch; i++) {
    sum += 0.5 * branch_element(p, i)[0] * e[i] * e[i];
  }
  return sum;
}

double branches_heat(const InerterDevice* p, const double* e) {
  double sum = 0;
  for (int i = 0; i < p->nbranch; i++) {
    const double* branch = branch_element(p, i);
    sum += branch[0] * e[i] * (branch[0] * e[i] / branch[1]);
  }
  return sum;
}
