#include "takt/kinematics/kinematics.h"

#include <pybind11/stl.h>
#include <pybind11/typing.h>

#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bindings.h"
#include "takt/core/angle.h"
#include "takt/core/arguments.h"
#include "takt/core/schema.h"
#include "takt/kinematics/links.h"
#include "takt/kinematics/serial.h"
#include "takt/workspace/mesh.h"
#include "takt/workspace/urdf_links.h"

namespace takt::bindings {
namespace {

using kinematics::Configuration;
using kinematics::Frame;
using kinematics::JointMotion;
using kinematics::Joints;
using kinematics::Kinematics;
using kinematics::MovingFrame;
using kinematics::Pose;
using kinematics::Reason;

constexpr std::size_t kMaxMechanismBytes = 64'000'000;  // a URDF may be inside

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Reasons = py::array_t<std::uint8_t>;
using ValuesAndReasons = std::pair<Numbers, Reasons>;

std::size_t RowsOf(const Numbers& table, std::size_t columns) {
  if (table.ndim() != 2 || static_cast<std::size_t>(table.shape(1)) != columns)
    throw std::invalid_argument("expected rows of " + std::to_string(columns) + " numbers");
  return static_cast<std::size_t>(table.shape(0));
}

Numbers Table(std::size_t rows, std::size_t columns) {
  Numbers table({rows, columns});
  std::fill_n(table.mutable_data(), rows * columns, kNone);
  return table;
}

// A reason for each row.
class Verdicts {
 public:
  explicit Verdicts(std::size_t rows) : reasons_(static_cast<py::ssize_t>(rows)) {}
  bool Take(std::size_t row, Reason reason) {
    reasons_.mutable_data()[row] = static_cast<std::uint8_t>(reason);
    return reason == Reason::kNone;
  }
  const Reasons& reasons() const { return reasons_; }

 private:
  Reasons reasons_;
};

Pose PoseAt(const Numbers& table, std::size_t row) {
  const double* p = table.data() + row * 6;
  return {p[0], p[1], p[2], p[3], p[4], p[5]};
}

void Put(Numbers& table, std::size_t row, const Pose& pose) {
  const std::array<double, 6> values{pose.x, pose.y, pose.z, pose.a, pose.b, pose.c};
  std::copy(values.begin(), values.end(), table.mutable_data() + row * 6);
}

// Velocities and accelerations of a tool: mm and, turning, deg; held in rad.
KDL::Twist TwistAt(const Numbers& table, std::size_t row) {
  const double* p = table.data() + row * 6;
  return {KDL::Vector(p[0], p[1], p[2]), KDL::Vector(p[3], p[4], p[5]) * kDegree};
}

void Put(double* six, std::size_t stride, const KDL::Twist& twist) {
  for (int i = 0; i < 3; ++i) {
    six[static_cast<std::size_t>(i) * stride] = twist.vel(i);
    six[static_cast<std::size_t>(i + 3) * stride] = twist.rot(i) / kDegree;
  }
}

class Mechanism {
 public:
  Mechanism(const std::string& text, const std::string& folder) {
    kinematics::KinematicsParams params;
    Problem problem;
    if (!ReadArguments(params, text, &problem, kMaxMechanismBytes))
      ThrowConfigError({Sentence(problem.path, problem.message)});
    kinematics::MakeResult made = kinematics::Make(params, folder);
    if (!made.kinematics) ThrowConfigError({Sentence(made.path, made.problem)});
    kinematics_ = *made.kinematics;
  }

  std::size_t axes() const { return kinematics_.count; }
  std::vector<bool> rotary() const {
    std::vector<bool> out;
    for (std::size_t i = 0; i < axes(); ++i) out.push_back(kinematics_.kinds[i] == kinematics::JointKind::kRotary);
    return out;
  }

  Numbers Ranges() const {
    Numbers table = Table(axes(), 2);
    for (std::size_t i = 0; i < axes(); ++i) {
      table.mutable_data()[2 * i] = kinematics_.ranges[i].lower;
      table.mutable_data()[2 * i + 1] = kinematics_.ranges[i].upper;
    }
    return table;
  }
  void SetRanges(const Numbers& table) {
    if (RowsOf(table, 2) != axes()) throw std::invalid_argument("expected one range for each axis");
    for (std::size_t i = 0; i < axes(); ++i) kinematics_.ranges[i] = {table.data()[2 * i], table.data()[2 * i + 1]};
  }

  ValuesAndReasons Forward(const Numbers& joints) const {
    const std::size_t rows = RowsOf(joints, axes());
    Numbers poses = Table(rows, 6);
    Verdicts verdicts(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      Frame tool;
      if (verdicts.Take(i, kinematics::Forward(kinematics_, JointsAt(joints, i), tool)))
        Put(poses, i, kinematics::ToPose(tool));
    }
    return {poses, verdicts.reasons()};
  }

  auto ForwardMotion(const Numbers& joints, const Numbers& velocities, const Numbers& accelerations) const {
    const std::size_t rows = SameRows(RowsOf(joints, axes()), velocities, accelerations, axes());
    Numbers poses = Table(rows, 6), rates = Table(rows, 6), changes = Table(rows, 6);
    Verdicts verdicts(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      const JointMotion motion{JointsAt(joints, i), JointsAt(velocities, i), JointsAt(accelerations, i)};
      MovingFrame tool;
      if (!verdicts.Take(i, kinematics::Forward(kinematics_, motion, tool))) continue;
      Put(poses, i, kinematics::ToPose(tool.GetFrame()));
      Put(rates.mutable_data() + i * 6, 1, tool.GetTwist());
      Put(changes.mutable_data() + i * 6, 1, tool.GetAccTwist());
    }
    return std::tuple(poses, rates, changes, verdicts.reasons());
  }

  ValuesAndReasons Inverse(const Numbers& poses, const Numbers& near, const std::string& configuration,
                           bool path) const {
    const std::size_t rows = RowsOf(poses, 6);
    Numbers joints = Table(rows, axes());
    Verdicts verdicts(rows);
    Start start(*this, near, rows, path);
    const Configuration wanted = Read(configuration);
    for (std::size_t i = 0; i < rows; ++i) {
      Joints found{};
      const Frame tool = kinematics::ToFrame(PoseAt(poses, i));
      if (!verdicts.Take(i, kinematics::Inverse(kinematics_, tool, wanted, start.At(i), found))) continue;
      Put(joints, i, found);
      start.Found(found);
    }
    return {joints, verdicts.reasons()};
  }

  auto InverseMotion(const Numbers& poses, const Numbers& velocities, const Numbers& accelerations, const Numbers& near,
                     const std::string& configuration, bool path) const {
    const std::size_t rows = SameRows(RowsOf(poses, 6), velocities, accelerations, 6);
    Numbers joints = Table(rows, axes()), rates = Table(rows, axes()), changes = Table(rows, axes());
    Verdicts verdicts(rows);
    Start start(*this, near, rows, path);
    const Configuration wanted = Read(configuration);
    for (std::size_t i = 0; i < rows; ++i) {
      const MovingFrame tool(kinematics::ToFrame(PoseAt(poses, i)), TwistAt(velocities, i), TwistAt(accelerations, i));
      JointMotion found;
      if (!verdicts.Take(i, kinematics::Inverse(kinematics_, tool, wanted, start.At(i), found))) continue;
      Put(joints, i, found.position);
      Put(rates, i, found.velocity);
      Put(changes, i, found.acceleration);
      start.Found(found.position);
    }
    return std::tuple(joints, rates, changes, verdicts.reasons());
  }

  ValuesAndReasons JacobianAt(const Numbers& joints) const {
    const std::size_t rows = RowsOf(joints, axes());
    Numbers out({rows, std::size_t{6}, axes()});
    std::fill_n(out.mutable_data(), rows * 6 * axes(), kNone);
    Verdicts verdicts(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      kinematics::Jacobian columns;
      if (!verdicts.Take(i, kinematics::JacobianAt(kinematics_, JointsAt(joints, i), columns))) continue;
      for (std::size_t k = 0; k < axes(); ++k) Put(out.mutable_data() + i * 6 * axes() + k, axes(), columns[k]);
    }
    return {out, verdicts.reasons()};
  }

  std::vector<std::string> Links() const {
    std::vector<std::string> names;
    for (const kinematics::LinkInfo& link : kinematics::LinksOf(kinematics_)) names.push_back(link.name);
    return names;
  }

  // Of every link its own axis and the next one, (rows, links, 6).
  ValuesAndReasons LinkPlaces(const Numbers& joints) const {
    const std::size_t rows = RowsOf(joints, axes());
    const std::vector<kinematics::LinkInfo> links = kinematics::LinksOf(kinematics_);
    Numbers places({rows, links.size(), std::size_t{6}});
    std::fill_n(places.mutable_data(), rows * links.size() * 6, kNone);
    Verdicts verdicts(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      kinematics::LinkFrameArray frames;
      if (!verdicts.Take(i, kinematics::LinkFrames(kinematics_, JointsAt(joints, i), frames))) continue;
      for (std::size_t k = 0; k < links.size(); ++k) {
        double* six = places.mutable_data() + (i * links.size() + k) * 6;
        std::copy_n(frames[k].p.data, 3, six);
        std::copy_n((frames[k] * links[k].span).data, 3, six + 3);
      }
    }
    return {places, verdicts.reasons()};
  }

  // Of every link its frame as the upper three rows of a matrix, in mm, (rows, links, 12).
  ValuesAndReasons LinkFrames(const Numbers& joints) const {
    const std::size_t rows = RowsOf(joints, axes());
    const std::size_t count = kinematics::LinksOf(kinematics_).size();
    Numbers matrices({rows, count, std::size_t{12}});
    std::fill_n(matrices.mutable_data(), rows * count * 12, kNone);
    Verdicts verdicts(rows);
    for (std::size_t i = 0; i < rows; ++i) {
      kinematics::LinkFrameArray frames;
      if (!verdicts.Take(i, kinematics::LinkFrames(kinematics_, JointsAt(joints, i), frames))) continue;
      for (std::size_t k = 0; k < count; ++k) {
        double* twelve = matrices.mutable_data() + (i * count + k) * 12;
        for (int row = 0; row < 3; ++row) {
          for (int column = 0; column < 3; ++column) *twelve++ = frames[k].M(row, column);
          *twelve++ = frames[k].p(row);
        }
      }
    }
    return {matrices, verdicts.reasons()};
  }

  // Of every link where the next axis is, in its own frame, mm, (links, 3).
  Numbers LinkSpans() const {
    const std::vector<kinematics::LinkInfo> links = kinematics::LinksOf(kinematics_);
    Numbers spans = Table(links.size(), 3);
    for (std::size_t k = 0; k < links.size(); ++k) std::copy_n(links[k].span.data, 3, spans.mutable_data() + 3 * k);
    return spans;
  }

  // Names of shoulder, elbow, wrist.
  std::vector<std::string> ConfigurationAt(const Numbers& joints) const {
    if (RowsOf(joints, axes()) != 1) throw std::invalid_argument("expected one row");
    const Configuration configuration = kinematics::ConfigurationOf(kinematics_, JointsAt(joints, 0));
    std::vector<std::string> names;
    for (const Field& field : TypeOf<Configuration>().fields) {
      const std::int64_t value = IntegerAt(*field.type, FieldAt(field, &configuration));
      names.emplace_back(field.type->FindEnumerator(value)->name);
    }
    return names;
  }

 private:
  // Where each row starts from: a row of its own, the only one there is, or what the row before led to.
  class Start {
   public:
    Start(const Mechanism& mechanism, const Numbers& near, std::size_t rows, bool path)
        : mechanism_(mechanism), near_(near), given_(RowsOf(near, mechanism.axes())), path_(path) {
      if (given_ != 1 && (path || given_ != rows))
        throw std::invalid_argument("expected one row of near, or one a pose");
      first_ = mechanism.JointsAt(near, 0);
    }
    Joints At(std::size_t row) const { return given_ == 1 ? first_ : mechanism_.JointsAt(near_, row); }
    void Found(const Joints& joints) {
      if (path_) first_ = joints;
    }

   private:
    const Mechanism& mechanism_;
    const Numbers& near_;
    std::size_t given_;
    bool path_;
    Joints first_{};
  };

  static std::string Sentence(const std::string& path, const std::string& message) {
    return path.empty() ? message : path + ": " + message;
  }

  static Configuration Read(const std::string& text) {
    Configuration configuration;
    Problem problem;
    if (!ReadArguments(configuration, text, &problem)) ThrowConfigError({Sentence(problem.path, problem.message)});
    return configuration;
  }

  static std::size_t SameRows(std::size_t rows, const Numbers& velocities, const Numbers& accelerations,
                              std::size_t columns) {
    if (RowsOf(velocities, columns) != rows || RowsOf(accelerations, columns) != rows)
      throw std::invalid_argument("expected as many rows of velocities and accelerations as of positions");
    return rows;
  }

  Joints JointsAt(const Numbers& table, std::size_t row) const {
    Joints joints{};
    std::copy_n(table.data() + row * axes(), axes(), joints.begin());
    return joints;
  }
  void Put(Numbers& table, std::size_t row, const Joints& joints) const {
    std::copy_n(joints.begin(), axes(), table.mutable_data() + row * axes());
  }
  static void Put(Numbers& table, std::size_t row, const Pose& pose) { bindings::Put(table, row, pose); }
  static void Put(double* six, std::size_t stride, const KDL::Twist& twist) { bindings::Put(six, stride, twist); }

  Kinematics kinematics_;
};

Numbers ToMatrices(const Numbers& poses) {
  const std::size_t rows = RowsOf(poses, 6);
  Numbers out({rows, std::size_t{4}, std::size_t{4}});
  for (std::size_t i = 0; i < rows; ++i) {
    double* matrix = out.mutable_data() + i * 16;
    kinematics::ToFrame(PoseAt(poses, i)).Make4x4(matrix);
  }
  return out;
}

Numbers ToPoses(const Numbers& matrices) {
  if (matrices.ndim() != 3 || matrices.shape(1) != 4 || matrices.shape(2) != 4)
    throw std::invalid_argument("expected matrices of 4 by 4");
  const auto rows = static_cast<std::size_t>(matrices.shape(0));
  Numbers out = Table(rows, 6);
  for (std::size_t i = 0; i < rows; ++i) {
    const double* m = matrices.data() + i * 16;
    const KDL::Rotation rotation(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]);
    Put(out, i, kinematics::ToPose(Frame(rotation, {m[3], m[7], m[11]})));
  }
  return out;
}

Numbers Between(const Numbers& ends, const Numbers& shares) {
  if (RowsOf(ends, 6) != 2 || shares.ndim() != 1)
    throw std::invalid_argument("expected two poses and a list of shares");
  const Frame from = kinematics::ToFrame(PoseAt(ends, 0)), to = kinematics::ToFrame(PoseAt(ends, 1));
  const kinematics::GreatArc arc = kinematics::ArcBetween(from.M, to.M);
  const auto rows = static_cast<std::size_t>(shares.shape(0));
  Numbers out = Table(rows, 6);
  for (std::size_t i = 0; i < rows; ++i) {
    const double share = shares.data()[i];
    Put(out, i, kinematics::ToPose(Frame(kinematics::Along(arc, {share, 0, 0}).R, from.p + (to.p - from.p) * share)));
  }
  return out;
}

std::vector<std::string> ReasonNames() {
  std::vector<std::string> names;
  for (const Enumerator& e : TypeOf<Reason>().enumerators) names.emplace_back(e.name);
  return names;
}

std::vector<std::string> ReasonTexts() {
  std::vector<std::string> texts;
  for (const Enumerator& e : TypeOf<Reason>().enumerators)
    texts.emplace_back(kinematics::Text(static_cast<Reason>(e.value)));
  return texts;
}

// Returns the solids of the links of a chain as JSON, in the form of a workspace: the <visual> elements of the URDF, or
// the <collision> elements.
std::vector<std::string> UrdfSolids(const std::string& urdf, const std::string& base, const std::string& tip,
                                    const std::string& folder, bool visual) {
  const auto purpose = visual ? kinematics::UrdfPurpose::kVisual : kinematics::UrdfPurpose::kCollision;
  kinematics::KinematicsParams params;
  params.serial = {urdf, base, tip};
  std::vector<std::string> solids;
  const kinematics::MakeResult made = kinematics::Make(params);
  if (!made.kinematics) return solids;
  const workspace::UrdfLinks urdf_links = workspace::LinksOfUrdf(*params.serial, *made.kinematics, "", folder, purpose);
  for (const workspace::SolidParams& solid : urdf_links.links)
    solids.push_back(ToJson(TypeOf<workspace::SolidParams>(), &solid).dump());
  return solids;
}

// Returns the names of the joints of a chain, and of its tip.
std::pair<std::vector<std::string>, std::string> UrdfChainNames(const std::string& urdf, const std::string& base,
                                                                const std::string& tip) {
  kinematics::UrdfNames names = kinematics::ReadUrdfNames(urdf, base, tip);
  return {std::move(names.joints), std::move(names.tip)};
}

// Returns the file of a mesh of a URDF in `folder`.
std::string UrdfMeshFile(const std::string& mesh, const std::string& folder) {
  return workspace::FileOfMesh(mesh, "", folder);
}

using Surface = std::pair<Numbers, py::array_t<std::uint32_t>>;

// Vertices (n, 3) in mm and triangles (m, 3) of an STL file; nothing where it cannot be read.
std::optional<Surface> SurfaceOf(const std::string& path, double scale) {
  std::string why;
  const std::optional<workspace::Mesh> mesh = workspace::LoadStl(path, scale, why);
  if (!mesh) return std::nullopt;
  Numbers vertices = Table(mesh->vertices.size(), 3);
  for (std::size_t i = 0; i < mesh->vertices.size(); ++i)
    std::copy_n(mesh->vertices[i].data, 3, vertices.mutable_data() + 3 * i);
  py::array_t<std::uint32_t> triangles({mesh->triangles.size(), std::size_t{3}});
  std::uint32_t* corner = triangles.mutable_data();
  for (const std::array<std::size_t, 3>& triangle : mesh->triangles)
    for (const std::size_t vertex : triangle) *corner++ = static_cast<std::uint32_t>(vertex);
  return Surface{vertices, triangles};
}

}  // namespace

void BindKinematics(py::module_& m) {
  m.def("reason_names", &ReasonNames, "Why a pose may have no position of the axes: names by number.");
  m.def("reason_texts", &ReasonTexts, "The same as sentences.");
  m.def("poses_to_matrices", &ToMatrices, py::arg("poses"));
  m.def("matrices_to_poses", &ToPoses, py::arg("matrices"));
  m.def("urdf_solids", &UrdfSolids, py::arg("urdf"), py::arg("base"), py::arg("tip"), py::arg("folder"),
        py::arg("visual"));
  m.def("urdf_chain_names", &UrdfChainNames, py::arg("urdf"), py::arg("base"), py::arg("tip"));
  m.def("urdf_mesh_file", &UrdfMeshFile, py::arg("mesh"), py::arg("folder"));
  m.def("surface_of_stl", &SurfaceOf, py::arg("path"), py::arg("scale"));
  m.def("poses_between", &Between, py::arg("ends"), py::arg("shares"));

  py::class_<Mechanism>(m, "Mechanism", "The kinematics of a group of axes, on tables with a row a position.")
      .def(py::init<const std::string&, const std::string&>(), py::arg("text"), py::arg("folder"))
      .def_property_readonly("axes", &Mechanism::axes)
      .def_property_readonly("rotary", &Mechanism::rotary)
      .def_property("ranges", &Mechanism::Ranges, &Mechanism::SetRanges)
      .def("forward", &Mechanism::Forward, py::arg("joints"))
      .def("forward_motion", &Mechanism::ForwardMotion, py::arg("joints"), py::arg("velocities"),
           py::arg("accelerations"))
      .def("inverse", &Mechanism::Inverse, py::arg("poses"), py::arg("near"), py::arg("configuration"), py::arg("path"))
      .def("inverse_motion", &Mechanism::InverseMotion, py::arg("poses"), py::arg("velocities"),
           py::arg("accelerations"), py::arg("near"), py::arg("configuration"), py::arg("path"))
      .def("jacobian", &Mechanism::JacobianAt, py::arg("joints"))
      .def_property_readonly("links", &Mechanism::Links)
      .def("link_places", &Mechanism::LinkPlaces, py::arg("joints"))
      .def("link_frames", &Mechanism::LinkFrames, py::arg("joints"))
      .def_property_readonly("link_spans", &Mechanism::LinkSpans)
      .def("configuration", &Mechanism::ConfigurationAt, py::arg("joints"));
}

}  // namespace takt::bindings
