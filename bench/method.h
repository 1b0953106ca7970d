#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "matcher/match.h"
#include "matcher/oriented_point.h"

namespace edgepose::bench {

/// One object, as every method gets it.
struct Object {
  int id = 0;
  Mesh mesh;            ///< metres, with normals
  double diameter = 0;  ///< [m]
  Symmetries symmetries;
};

/// One image, as every method gets it. The peers search `points`, ours searches the image.
struct Frame {
  DepthImage depth;
  Camera camera;
  std::vector<OrientedPoint> points;  ///< [m] camera frame, normals towards the camera
  double normal_seconds = 0;          ///< wall time that `points` took
};

/// A matching method under comparison. Every question is asked with one model at a time.
class Method {
 public:
  virtual ~Method() = default;
  virtual std::string name() const = 0;
  virtual std::string settings() const = 0;  ///< one line, for the report
  virtual void train(const Object& object) = 0;
  /// Where the object is; nothing if the method says that it is not there.
  virtual std::optional<RigidTransform> find(const Object& object, const Frame& frame) = 0;
  /// Whether find() computes its own normals from the depth image.
  virtual bool brings_its_preprocessing() const { return false; }
};

std::unique_ptr<Method> edgepose_method(int threads);
std::unique_ptr<Method> opencv_method();
std::unique_ptr<Method> pcl_method();

/// One point for each cell of a grid `cell` metres wide: the mean of the points and normals in it. What the
/// peers' documentation asks to do before matching; the same for both.
std::vector<OrientedPoint> grid_sampled(const std::vector<OrientedPoint>& points, double cell);

/// The surface of the object's mesh as about `count` oriented points.
std::vector<OrientedPoint> surface_points(const Object& object, size_t count);

}  // namespace edgepose::bench
