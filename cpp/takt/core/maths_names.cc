// The names by which Ruckig's archive calls these functions instead of the C library's (cmake/TaktDependencies.cmake
// renames its imports). Signatures are those of C.
#include "takt/core/maths.h"

extern "C" {

double takt_acos(double x) {
  return takt::maths::Acos(x);
}
double takt_atan(double x) {
  return takt::maths::Atan(x);
}
double takt_cbrt(double x) {
  return takt::maths::Cbrt(x);
}
void takt_sincos(double x, double* sine, double* cosine) {
  const takt::maths::SineCosine of = takt::maths::SinCos(x);
  *sine = of.sine;
  *cosine = of.cosine;
}

}  // extern "C"
