// SPDX-License-Identifier: BSD-3-Clause
#include "robot/model.hpp"

#include <tuple>

#include "geometry/mesh_file.hpp"
#include "robot/srdf.hpp"
#include "robot/tree_builder.hpp"
#include "robot/urdf_check.hpp"
#include "robot/urdf_parse.hpp"
#include "support/log.hpp"

namespace tactus::robot {
namespace {

using geometry::Mesh;
using geometry::Vector3;

/// Loads every mesh file once for each scale it is used with.
class MeshCache {
 public:
  const Mesh& get(const std::filesystem::path& path, const Vector3& scale) {
    const Key key{path.string(), scale.x(), scale.y(), scale.z()};
    const auto known = meshes_.find(key);
    return known != meshes_.end() ? known->second
                                  : meshes_.emplace(key, geometry::load_mesh(path, scale)).first->second;
  }

 private:
  using Key = std::tuple<std::string, double, double, double>;
  std::map<Key, Mesh> meshes_;
};

Mesh mesh_of(const urdf::Geometry& shape, const std::filesystem::path& file, MeshCache& cache) {
  if (const auto* box = dynamic_cast<const urdf::Box*>(&shape))
    return geometry::box_mesh({box->dim.x, box->dim.y, box->dim.z});
  if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&shape))
    return geometry::cylinder_mesh(cylinder->radius, cylinder->length);
  if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&shape)) return geometry::sphere_mesh(sphere->radius);
  const auto& mesh = dynamic_cast<const urdf::Mesh&>(shape);
  return cache.get(file, {mesh.scale.x, mesh.scale.y, mesh.scale.z});
}

void load_shapes(const urdf::ModelInterface& parsed, const UrdfOutline& outline, RobotModel& model, XmlReport& report) {
  MeshCache cache;
  for (Link& link : model.links) {
    const auto& collisions = parsed.getLink(link.name)->collision_array;
    const auto& outlines = outline.collisions.at(link.name);
    for (std::size_t i = 0; i < collisions.size(); ++i) {
      try {
        const Mesh mesh = mesh_of(*collisions[i]->geometry, outlines[i].mesh, cache);
        link.shapes.push_back(geometry::transformed(mesh, pose_from(collisions[i]->origin)));
      } catch (const support::Error& error) {
        if (error.status() == support::Status::internal) throw;  // no mistake of the file's
        report.add(outlines[i].row, "link " + link.name, error.what(), "a mesh that can be used");
      }
    }
  }
}

void warn_if_shapeless(const RobotModel& model) {
  for (const Link& link : model.links)
    if (!link.shapes.empty()) return;
  support::log(support::LogLevel::warning,
               "robot " + model.name + " has no collision shapes: nothing it does will touch anything");
}

}  // namespace

int RobotModel::find_link(const std::string& wanted) const {
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i].name == wanted) return static_cast<int>(i);
  return -1;
}

RobotModel load_model(const ModelSource& source) {
  TiXmlDocument document;
  read_xml(source.urdf, document);
  XmlReport report(source.urdf);
  const UrdfOutline outline = check_urdf(*document.RootElement(), source, report);
  report.throw_if_any();
  const urdf::ModelInterfaceSharedPtr parsed = parse_urdf(document, outline, report);
  RobotModel model = build_tree(*parsed, outline);
  load_shapes(*parsed, outline, model, report);
  report.throw_if_any();
  warn_if_shapeless(model);
  if (!source.srdf.empty()) model.disabled_pairs = read_disabled_pairs(source.srdf, model);
  return model;
}

}  // namespace tactus::robot
