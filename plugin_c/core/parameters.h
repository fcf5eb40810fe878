// The parameters of a device, each declared here once: name, unit, default, bounds, meaning.
// The C struct, the MJCF configuration, Python, the README table and every error text read this
// list.

#ifndef INERTER_CORE_PARAMETERS_H_
#define INERTER_CORE_PARAMETERS_H_

#include <math.h>

// X(name, unit, default, lower, upper, bound, laws, meaning)
//   default: NAN: when it is not set it is derived from other parameters, or the part is absent.
//   bound: CLOSED allows the lower bound itself, OPEN does not. Values are always finite.
//   laws: the friction laws that read it; "" for the device itself.
#define INERTER_PARAMETERS(X)                                                                      \
  /* linear */                                                                                     \
  X(inertance, "kg", 0, 0, INFINITY, CLOSED, "", "force per relative acceleration, b")             \
  X(viscous, "N*s/m", 0, 0, INFINITY, CLOSED, "", "viscous damping, c (sigma2 of LuGre)")          \
  X(stiffness, "N/m", 0, -INFINITY, INFINITY, CLOSED, "", "parallel stiffness, k")                 \
  X(rest_length, "m", 0, -INFINITY, INFINITY, CLOSED, "", "length at which x is 0")                \
  /* other force laws */                                                                           \
  X(quadratic_damping, "N*s^2/m^2", 0, 0, INFINITY, CLOSED, "", "force per v*abs(v), c2")          \
  X(damping_asymmetry, "1", 0, -0.999, 0.999, CLOSED, "",                                          \
    "relative rise of all damping while x grows, fall while it shrinks")                           \
  X(damping_knee, "m/s", 0, 0, INFINITY, CLOSED, "",                                               \
    "speed at which viscous damping bends, v_k; 0: it does not")                                   \
  X(damping_beyond, "1", 1, 0, INFINITY, CLOSED, "",                                               \
    "slope of viscous damping beyond the knee, relative to that below")                            \
  X(damping_sharpness, "1", 2, 1, 64, CLOSED, "",                                                  \
    "how sharply viscous damping bends at the knee, n; 2: gently, 64: a corner")                   \
  X(damping_exponent, "1", 0, -1, 1, CLOSED, "",                                                   \
    "power of the speed that what bends goes with beyond the knee; -1: an eddy-current brake")     \
  X(damping_knee_back, "m/s", NAN, 0, INFINITY, CLOSED, "",                                        \
    "the knee while x shrinks; unset: damping_knee")                                               \
  X(damping_beyond_back, "1", NAN, 0, INFINITY, CLOSED, "",                                        \
    "the slope beyond it while x shrinks; unset: damping_beyond")                                  \
  X(damper_stiffness, "N/m", 0, 0, INFINITY, CLOSED, "",                                           \
    "stiffness in series with the dampers between the terminals, k_d; 0: rigid")                   \
  X(stiffness_cubic, "N/m^3", 0, -INFINITY, INFINITY, CLOSED, "", "force per x^3, k3")             \
  X(force_offset, "N", 0, -INFINITY, INFINITY, CLOSED, "", "constant force")                       \
  X(load_friction, "1", 0, 0, 1, CLOSED, "", "friction per inertance force, mu")                   \
  X(inertance_gradient, "1/m", 0, -INFINITY, INFINITY, CLOSED, "",                                 \
    "relative rise of the inertance per x")                                                        \
  X(inertance_curvature, "1/m^2", 0, -INFINITY, INFINITY, CLOSED, "",                              \
    "relative rise of the inertance per x^2")                                                      \
  X(inertance_speed_gradient, "s/m", 0, -INFINITY, INFINITY, CLOSED, "",                           \
    "relative rise of the inertance per abs(v), g")                                                \
  X(flywheel_viscous, "N*s/m", 0, 0, INFINITY, CLOSED, "",                                         \
    "viscous damping of the flywheel itself")                                                      \
  /* elasticity and play between the terminals and the flywheel */                                 \
  X(series_stiffness, "N/m", 0, 0, INFINITY, CLOSED, "",                                           \
    "stiffness in series with the inertance, k_s; 0 and no series_damping: rigid")                 \
  X(series_damping, "N*s/m", 0, 0, INFINITY, CLOSED, "",                                           \
    "damping in series with the inertance, c_s")                                                   \
  X(series_hardening, "1/m", 0, -INFINITY, INFINITY, CLOSED, "",                                   \
    "relative rise of the series stiffness per deflection, q")                                     \
  X(backlash, "m", 0, 0, INFINITY, CLOSED, "", "half of the free play of the series element, eps") \
  X(clutch_force, "N", 0, 0, INFINITY, CLOSED, "",                                                 \
    "force at which a clutch in series with the inertance slips, F_c; 0: no clutch")               \
  X(clutch_asymmetry, "1", 0, -1, 1, CLOSED, "",                                                   \
    "relative rise of clutch_force in tension, fall in compression; 1 or -1: a one-way clutch")    \
  X(leak_damping, "N*s/m", 0, 0, INFINITY, CLOSED, "",                                             \
    "force per velocity of the slip, c_l: a laminar leak; 0: none")                                \
  X(leak_quadratic_damping, "N*s^2/m^2", 0, 0, INFINITY, CLOSED, "",                               \
    "force per velocity of the slip squared, q_l: a turbulent leak; 0: none")                      \
  /* end stops */                                                                                  \
  X(stop_lower, "m", NAN, -INFINITY, INFINITY, CLOSED, "",                                         \
    "x below which it stops; unset: no stop")                                                      \
  X(stop_upper, "m", NAN, -INFINITY, INFINITY, CLOSED, "",                                         \
    "x above which it stops; unset: no stop")                                                      \
  X(stop_stiffness, "N/m", 0, 0, INFINITY, CLOSED, "", "stiffness of the end stops, k_e")          \
  X(stop_stiffness_cubic, "N/m^3", 0, 0, INFINITY, CLOSED, "",                                     \
    "rise of that stiffness: force per depth^3, k_e3")                                             \
  X(stop_damping, "s/m", 0, 0, INFINITY, CLOSED, "",                                               \
    "relative rise of the stop force per approach speed, e")                                       \
  /* gas spring */                                                                                 \
  X(gas_pressure, "Pa", 0, 0, INFINITY, CLOSED, "", "pressure at x = 0 and around, p0; 0: no gas") \
  X(gas_area, "m^2", NAN, -INFINITY, INFINITY, CLOSED, "",                                         \
    "piston area on the gas, A; below 0: lengthening compresses it; unset: piston_area")           \
  X(gas_volume, "m^3", 0, 0, INFINITY, CLOSED, "", "gas volume at x = 0, V0")                      \
  X(gas_exponent, "1", 1.4, 0, 5, OPEN, "", "polytropic exponent of the gas, gamma")               \
  /* fluid in a channel: inertance and loss from the geometry */                                   \
  X(piston_area, "m^2", 0, 0, INFINITY, CLOSED, "", "area that moves the fluid, A1")               \
  X(channel_area, "m^2", 0, 0, INFINITY, CLOSED, "", "cross-section of the channel, A2")           \
  X(channel_length, "m", 0, 0, INFINITY, CLOSED, "",                                               \
    "length of the channel, l: b = rho l A1^2 / A2")                                               \
  X(fluid_density, "kg/m^3", 1000, 0, INFINITY, OPEN, "", "density of the fluid, rho")             \
  X(fluid_viscosity, "Pa*s", 0, 0, INFINITY, CLOSED, "",                                           \
    "dynamic viscosity, mu; 0: no wall friction")                                                  \
  X(channel_roughness, "m", 0, 0, INFINITY, CLOSED, "", "roughness of the channel's wall")         \
  X(minor_loss, "1", 0, 0, INFINITY, CLOSED, "", "loss at bends and ends per rho u^2 / 2, K")      \
  /* friction levels, shared by every law but Bouc-Wen */                                          \
  X(coulomb_force, "N", 0, 0, INFINITY, CLOSED,                                                    \
    "coulomb stribeck dahl lugre brown_mcphee rate_state", "sliding friction level, f_c")          \
  X(static_force, "N", NAN, 0, INFINITY, CLOSED, "stribeck lugre brown_mcphee",                    \
    "breakaway level, f_s >= f_c; unset: f_c")                                                     \
  X(stribeck_velocity, "m/s", 1e-2, 0, INFINITY, OPEN, "stribeck lugre brown_mcphee",              \
    "speed, v_s, at which 1/e of f_s - f_c is left; brown_mcphee: of the peak")                    \
  X(stribeck_exponent, "1", 2, 0, 10, OPEN, "stribeck lugre", "shape of the fall from f_s to f_c") \
  X(transition_velocity, "m/s", 1e-4, 0, INFINITY, OPEN, "", "width of sign(v) = tanh(v / width)") \
  X(friction_asymmetry, "1", 0, -0.999, 0.999, CLOSED,                                             \
    "coulomb stribeck dahl lugre brown_mcphee maxwell_slip rate_state",                            \
    "relative rise of the level for v > 0, fall for v < 0")                                        \
  X(friction_gradient, "1/m", 0, -INFINITY, INFINITY, CLOSED,                                      \
    "coulomb stribeck dahl lugre brown_mcphee maxwell_slip rate_state",                            \
    "relative rise of the level per x")                                                            \
  X(friction_curvature, "1/m^2", 0, -INFINITY, INFINITY, CLOSED,                                   \
    "coulomb stribeck dahl lugre brown_mcphee maxwell_slip rate_state",                            \
    "relative rise of the level per x^2")                                                          \
  /* bristles: Dahl and LuGre; free play also Bouc-Wen */                                          \
  X(bristle_stiffness, "N/m", 1e5, 0, INFINITY, OPEN, "dahl lugre",                                \
    "pre-sliding stiffness, sigma0")                                                               \
  X(bristle_damping, "N*s/m", 0, 0, INFINITY, CLOSED, "lugre", "LuGre micro-damping, sigma1")      \
  X(dahl_exponent, "1", 1, 0, 10, CLOSED, "dahl", "shape of the Dahl loop")                        \
  X(friction_backlash, "m", 0, 0, INFINITY, CLOSED, "dahl lugre bouc_wen",                         \
    "half of the free play before the friction, eps")                                              \
  /* Bouc-Wen */                                                                                   \
  X(bw_alpha, "1", 1, 0, INFINITY, OPEN, "bouc_wen", "z' per v while elastic, alpha")              \
  X(bw_beta, "m^-n", 0.5, -INFINITY, INFINITY, CLOSED, "bouc_wen", "hysteresis shape, beta")       \
  X(bw_gamma, "m^-n", 0.5, -INFINITY, INFINITY, CLOSED, "bouc_wen", "hysteresis shape, gamma")     \
  X(bw_exponent, "1", 1, 1, 20, CLOSED, "bouc_wen", "sharpness of yielding, n")                    \
  X(bw_stiffness, "N/m", 0, 0, INFINITY, CLOSED, "bouc_wen", "k0: F = A k0 x + (1 - A) k0 z")      \
  X(bw_ratio, "1", 0, -INFINITY, INFINITY, CLOSED, "bouc_wen", "elastic share A")                  \
  /* Maxwell-slip: elements from the first to the last, each a spring that slips */                \
  X(slip_stiffness_1, "N/m", 0, 0, INFINITY, CLOSED, "maxwell_slip",                               \
    "stiffness of element 1; 0: no such element")                                                  \
  X(slip_force_1, "N", 0, 0, INFINITY, CLOSED, "maxwell_slip", "force at which element 1 slips")   \
  X(slip_stiffness_2, "N/m", 0, 0, INFINITY, CLOSED, "maxwell_slip",                               \
    "stiffness of element 2; 0: no such element")                                                  \
  X(slip_force_2, "N", 0, 0, INFINITY, CLOSED, "maxwell_slip", "force at which element 2 slips")   \
  X(slip_stiffness_3, "N/m", 0, 0, INFINITY, CLOSED, "maxwell_slip",                               \
    "stiffness of element 3; 0: no such element")                                                  \
  X(slip_force_3, "N", 0, 0, INFINITY, CLOSED, "maxwell_slip", "force at which element 3 slips")   \
  X(slip_stiffness_4, "N/m", 0, 0, INFINITY, CLOSED, "maxwell_slip",                               \
    "stiffness of element 4; 0: no such element")                                                  \
  X(slip_force_4, "N", 0, 0, INFINITY, CLOSED, "maxwell_slip", "force at which element 4 slips")   \
  X(slip_stiffness_5, "N/m", 0, 0, INFINITY, CLOSED, "maxwell_slip",                               \
    "stiffness of element 5; 0: no such element")                                                  \
  X(slip_force_5, "N", 0, 0, INFINITY, CLOSED, "maxwell_slip", "force at which element 5 slips")   \
  X(slip_stiffness_6, "N/m", 0, 0, INFINITY, CLOSED, "maxwell_slip",                               \
    "stiffness of element 6; 0: no such element")                                                  \
  X(slip_force_6, "N", 0, 0, INFINITY, CLOSED, "maxwell_slip", "force at which element 6 slips")   \
  X(slip_stiffness_7, "N/m", 0, 0, INFINITY, CLOSED, "maxwell_slip",                               \
    "stiffness of element 7; 0: no such element")                                                  \
  X(slip_force_7, "N", 0, 0, INFINITY, CLOSED, "maxwell_slip", "force at which element 7 slips")   \
  X(slip_stiffness_8, "N/m", 0, 0, INFINITY, CLOSED, "maxwell_slip",                               \
    "stiffness of element 8; 0: no such element")                                                  \
  X(slip_force_8, "N", 0, 0, INFINITY, CLOSED, "maxwell_slip", "force at which element 8 slips")   \
  /* load friction by the direction of power */                                                    \
  X(mu_forward, "1", NAN, 0, INFINITY, CLOSED, "",                                                 \
    "load friction while the motion drives the flywheel; unset: load_friction")                    \
  X(mu_backward, "1", NAN, 0, 1, CLOSED, "",                                                       \
    "load friction while the flywheel drives the motion; unset: load_friction")                    \
  /* viscoelastic branches: each a spring and a dashpot in series */                               \
  X(branch_stiffness_1, "N/m", 0, 0, INFINITY, CLOSED, "", "spring of viscoelastic branch 1, K")   \
  X(branch_damping_1, "N*s/m", 0, 0, INFINITY, CLOSED, "",                                         \
    "dashpot of viscoelastic branch 1, in series with its spring, C")                              \
  X(branch_stiffness_2, "N/m", 0, 0, INFINITY, CLOSED, "", "spring of viscoelastic branch 2, K")   \
  X(branch_damping_2, "N*s/m", 0, 0, INFINITY, CLOSED, "",                                         \
    "dashpot of viscoelastic branch 2, in series with its spring, C")                              \
  X(branch_stiffness_3, "N/m", 0, 0, INFINITY, CLOSED, "", "spring of viscoelastic branch 3, K")   \
  X(branch_damping_3, "N*s/m", 0, 0, INFINITY, CLOSED, "",                                         \
    "dashpot of viscoelastic branch 3, in series with its spring, C")                              \
  /* along the stroke */                                                                           \
  X(curve_lower, "m", NAN, -INFINITY, INFINITY, CLOSED, "", "x of the first value of every curve") \
  X(curve_upper, "m", NAN, -INFINITY, INFINITY, CLOSED, "", "x of the last value of every curve")  \
  X(coil_diameter, "m", 0, 0, INFINITY, CLOSED, "",                                                \
    "diameter of the coil that the channel is wound to, D_c; 0: straight")                         \
  /* rate-and-state friction */                                                                    \
  X(rate_effect, "1", 0.02, 0, INFINITY, CLOSED, "rate_state",                                     \
    "relative rise of the level per ln(v), at once, A")                                            \
  X(age_effect, "1", 0.03, 0, INFINITY, CLOSED, "rate_state",                                      \
    "relative rise of the level per ln(age of the contacts), B")                                   \
  X(rate_velocity, "m/s", 1e-3, 0, INFINITY, OPEN, "rate_state",                                   \
    "speed at which steady sliding is at coulomb_force, v_0")                                      \
  X(age_distance, "m", 1e-5, 0, INFINITY, OPEN, "rate_state",                                      \
    "way of sliding that renews the contacts, L")                                                  \
  /* a control that sets a parameter; values in its unit */                                        \
  X(control_lower, "1", NAN, -INFINITY, INFINITY, CLOSED, "",                                      \
    "smallest value that the control sets, in the unit of what it sets")                           \
  X(control_upper, "1", NAN, -INFINITY, INFINITY, CLOSED, "",                                      \
    "largest value that the control sets, in the unit of what it sets")                            \
  X(control_lag, "s", 0, 0, INFINITY, CLOSED, "",                                                  \
    "time constant with which the value follows the control; 0: at once")                          \
  /* a force over displacement and velocity: force_map (force_map.c) */                            \
  X(force_map_lower, "m", NAN, -INFINITY, INFINITY, CLOSED, "", "x of the first row of force_map") \
  X(force_map_upper, "m", NAN, -INFINITY, INFINITY, CLOSED, "", "x of the last row of force_map")  \
  X(force_map_speed, "m/s", NAN, 0, INFINITY, OPEN, "",                                            \
    "velocity of the last column of force_map; of the first: minus that")                          \
  X(force_map_scale, "m/s", NAN, 0, INFINITY, OPEN, "",                                            \
    "columns are evenly spaced in asinh(v / scale), fine near 0; unset: in v")                     \
  X(force_map_columns, "1", NAN, 2, 16, CLOSED, "", "columns of force_map, a whole number")        \
  X(force_map_passive, "1", 0, 0, 1, CLOSED, "",                                                   \
    "1: leave out what of force_map would give energy; 0: as stated")

// What changes along the stroke (curve.c): X(name, unit, laws, meaning). Each has two lists of
// numbers: NAME_curve, values at evenly spaced places, and NAME_periods, three numbers for each.
#define INERTER_STROKES(X)                                                              \
  X(friction, "1", "coulomb stribeck dahl lugre bouc_wen brown_mcphee rate_state",      \
    "relative rise of the friction level")                                              \
  X(friction_back, "1", "coulomb stribeck dahl lugre bouc_wen brown_mcphee rate_state", \
    "the same for v < 0, where it differs")                                             \
  X(inertance, "1", "", "relative rise of the inertance")                               \
  X(inertance_back, "1", "", "the same for v < 0, where it differs")                    \
  X(force, "N", "", "force of the place alone")                                         \
  X(viscous, "N*s/m", "", "viscous damping beside viscous")

// the friction laws: X(identifier, largest number of states, meaning)
#define INERTER_FRICTION_LAWS(X)                                                  \
  X(none, 0, "no friction")                                                       \
  X(coulomb, 0, "constant level against the motion")                              \
  X(stribeck, 0, "level falls from f_s to f_c with speed")                        \
  X(dahl, 1, "bristle that yields at f_c: memory, no Stribeck effect")            \
  X(lugre, 1, "bristle with Stribeck effect and micro-damping")                   \
  X(bouc_wen, 1, "smooth hysteresis with an elastic share")                       \
  X(brown_mcphee, 0, "smooth Stribeck curve without states")                      \
  X(maxwell_slip, 8, "springs that slip, side by side: memory of every reversal") \
  X(rate_state, 1, "level falls with ln(speed) and grows with ln(time at rest)")

// the laws of the gas spring: X(identifier, meaning)
#define INERTER_GAS_LAWS(X)              \
  X(polytropic, "p V^gamma is constant") \
  X(expanded, "second order of that, as a paper prints it")

// where the friction law and the load friction act: X(identifier, meaning)
#define INERTER_FRICTION_SIDES(X)                                  \
  X(terminals, "between the terminals, before the series element") \
  X(flywheel, "beside the inertance, behind the series element")

// what the control is: X(identifier, meaning); but for `force` the parameter that it sets
#define INERTER_CONTROLS(X)                                                        \
  X(force, "a force beside the device")                                            \
  X(viscous, "viscous damping: a magnetorheological or valve damper")              \
  X(quadratic_damping, "quadratic damping: an orifice")                            \
  X(flywheel_viscous, "viscous damping of the flywheel: a brake")                  \
  X(minor_loss, "loss of the channel: a valve in it")                              \
  X(coulomb_force, "sliding friction level: a clutch, a magnetorheological brake") \
  X(static_force, "breakaway friction level")                                      \
  X(stiffness, "parallel stiffness")                                               \
  X(bw_stiffness, "stiffness of the Bouc-Wen law: a magnetorheological damper")    \
  X(inertance, "inertance")

#endif  // INERTER_CORE_PARAMETERS_H_
