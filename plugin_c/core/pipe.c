// Fluid in a channel: inertance from its mass, and the loss of its flow.
//
//   b = rho l A1^2 / A2
//   F = A1 (f l / D + K) rho u^2 / 2 sgn(w),   u = (A1 / A2) |w|,   Re = rho u D / mu
//   f = 8 [(8 / Re)^12 + (P + Q)^-1.5]^(1/12)
//   P = [2.457 ln(1 / ((7 / Re)^0.9 + 0.27 roughness / D))]^16,   Q = (37530 / Re)^16
//
// In a coil of diameter D_c, De = Re sqrt(D / D_c):
//   f = [(64 c / Re)^12 + (8 (P + Q)^-0.125 + 0.03 sqrt(D / D_c))^12]^(1/12)
//   c = 1 / (1 - (1 - (11.6 / De)^0.45)^2.2),  1 for De <= 11.6
//
// w [m/s] velocity of the piston; A1, A2 [m^2] piston_area, channel_area; l [m] channel_length;
// D [m] = sqrt(4 A2 / pi), the channel's diameter; rho [kg/m^3] fluid_density; mu [Pa s]
// fluid_viscosity; roughness [m] channel_roughness; K minor_loss; f Darcy's friction factor.
// F lengthens for w > 0. mu = 0: K alone. No stored energy beside that of the inertance.
// Why Churchill and not Colebrook: laminar flow, transition and rough walls in one smooth formula,
// laminar f = 64 / Re, and within 1-2 % of Colebrook for Re above 1e4.
// Coil: D_c [m] coil_diameter, between the axes of the channel; 0: straight. The secondary flow of
// the bends (Dean) makes a laminar loss that grows faster than the speed, and puts turbulence off.
// c holds for De up to 2000; the turbulent part is that of the straight channel and a constant.
// Source: Churchill 1977; c: White 1929; turbulent coil: Mishra and Gupta 1979 (in Darcy's factor).
// Not modelled: entrance length, pitch of a coil, unsteady wall friction, compressibility.

#include "laws.h"

static const double kPi = 3.14159265358979323846;
static const double kLaminar = 700;       // below this Re the other terms are under 1e-16 of f
static const double kCoiledLaminar = 10;  // the same of a coil, where De < 11.6 too
static const double kDean = 11.6;

static double power12(double x) {
  double cube = x * x * x, sixth = cube * cube;
  return sixth * sixth;
}

static double power16(double x) {
  double square = x * x, fourth = square * square, eighth = fourth * fourth;
  return eighth * eighth;
}

// f, slope: d ln f / d ln Re
static Tangent churchill(double reynolds, double roughness) {
  double laminar = power12(8 / reynolds);
  double smooth = pow(7 / reynolds, 0.9), wall = smooth + 0.27 * roughness;
  double height = -2.457 * log(wall);
  double turbulent = power16(height), between = power16(37530 / reynolds);
  double sum = turbulent + between, rest = pow(sum, -1.5);

  // d(sum) / d ln Re: the height rises by 2.457 * 0.9 * smooth / wall
  double fifteenth = height == 0 ? 0 : turbulent / height;
  double rise = 16 * (fifteenth * 2.457 * 0.9 * smooth / wall - between);
  double slope = -(laminar + 0.125 * rest * rise / sum) / (laminar + rest);
  return (Tangent){8 * pow(laminar + rest, 1.0 / 12), slope};
}

// f of a coil of curvature D / D_c, slope as above
static Tangent coiled(double reynolds, double roughness, double curvature) {
  double root = sqrt(curvature), dean = reynolds * root, c = 1, c_slope = 0;
  if (dean > kDean) {
    double fall = pow(kDean / dean, 0.45), rise = 1 - fall, power = pow(rise, 1.2);
    c = 1 / (1 - power * rise);
    c_slope = c * 2.2 * power * 0.45 * fall;  // d ln c / d ln Re
  }
  double smooth = pow(7 / reynolds, 0.9), wall = smooth + 0.27 * roughness;
  double height = -2.457 * log(wall), between = power16(37530 / reynolds);
  double sum = power16(height) + between, straight = 8 * pow(sum, -0.125);
  double fifteenth = height == 0 ? 0 : power16(height) / height;
  double rise = 16 * (fifteenth * 2.457 * 0.9 * smooth / wall - between);
  double turbulent = straight + 0.03 * root, laminar = 64 * c / reynolds;

  // f = turbulent (1 + ratio^12)^(1/12) or the other way round, whichever does not overflow
  double large = fmax(laminar, turbulent), share = power12(laminar / large);
  double other = power12(turbulent / large), turbulent_slope = -0.125 * straight * rise / sum;
  double slope = share * (c_slope - 1) + other * turbulent_slope / turbulent;
  return (Tangent){large * pow(share + other, 1.0 / 12), slope / (share + other)};
}

double pipe_diameter(const InerterDevice* p) {
  return sqrt(4 * p->channel_area / kPi);
}

double pipe_inertance(const InerterDevice* p) {
  return p->fluid_density * p->channel_length * p->piston_area * p->piston_area / p->channel_area;
}

Tangent pipe_force(const InerterDevice* p, double w) {
  double ratio = p->piston_area / p->channel_area, u = ratio * fabs(w);
  double diameter = pipe_diameter(p);
  double pressure = 0.5 * p->minor_loss * p->fluid_density * u * u;
  double slope = p->minor_loss * p->fluid_density * u;
  if (p->fluid_viscosity > 0) {
    double reynolds = p->fluid_density * u * diameter / p->fluid_viscosity;
    double length = p->channel_length / diameter;
    double roughness = p->channel_roughness / diameter;
    if (reynolds < (p->coil_diameter > 0 ? kCoiledLaminar : kLaminar)) {
      double laminar = 32 * p->fluid_viscosity * length / diameter;
      pressure += laminar * u;
      slope += laminar;
    } else {
      Tangent f = p->coil_diameter > 0 ? coiled(reynolds, roughness, diameter / p->coil_diameter)
                                       : churchill(reynolds, roughness);
      double loss = f.value * length * p->fluid_density * u;
      pressure += 0.5 * loss * u;
      slope += fmax(0, loss * (1 + 0.5 * f.slope));
    }
  }
  return (Tangent){p->piston_area * pressure * sign(w), p->piston_area * slope * ratio};
}
