#include "bindings.h"

PYBIND11_MODULE(_core, m) {
  m.doc() = "The motion engine, as it comes from C++. Use the package takt, which is made for people.";
  m.attr("__version__") = TAKT_VERSION;
  takt::bindings::BindCore(m);
  takt::bindings::BindCam(m);
  takt::bindings::BindKinematics(m);
  takt::bindings::BindAxis(m);
  takt::bindings::BindEngine(m);
  takt::bindings::BindTrack(m);
  takt::bindings::BindRouting(m);
  takt::bindings::BindServo(m);
  takt::bindings::BindLcm(m);
}
