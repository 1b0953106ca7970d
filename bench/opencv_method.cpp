#include <algorithm>
#include <map>
#include <opencv2/surface_matching.hpp>
#include <opencv2/surface_matching/ppf_helpers.hpp>

#include "bench/method.h"

namespace edgepose::bench {
namespace {

using cv::ppf_match_3d::ICP;
using cv::ppf_match_3d::Pose3DPtr;
using cv::ppf_match_3d::PPF3DDetector;

constexpr double kSampling = 0.05, kDistance = 0.05;  // [d], as in its documentation
constexpr double kReferences = 1.0 / 5;
constexpr size_t kRefined = 5;  // best poses that get ICP, as in its sample program
constexpr size_t kModelPoints = 20000;

cv::Mat to_mat(const std::vector<OrientedPoint>& points) {
  cv::Mat mat(static_cast<int>(points.size()), 6, CV_32F);
  for (int row = 0; row < mat.rows; ++row) {
    const OrientedPoint& point = points[static_cast<size_t>(row)];
    auto* values = mat.ptr<float>(row);
    std::copy_n(point.position.data(), 3, values);
    std::copy_n(point.normal.data(), 3, values + 3);
  }
  return mat;
}

class OpenCv : public Method {
 public:
  std::string name() const override { return "OpenCV surface_matching"; }
  std::string settings() const override {
    return "sampling and distance step 0.05 d, 30 angles, 1/5 of the scene as references, ICP on the best "
           "5, " +
           std::to_string(cv::getNumThreads()) + " thread(s)";
  }

  void train(const Object& object) override {
    Trained& trained = models_[object.id];
    trained.points = to_mat(surface_points(object, kModelPoints));
    trained.detector = std::make_unique<PPF3DDetector>(kSampling, kDistance, 30);
    trained.detector->trainModel(trained.points);
  }

  std::optional<RigidTransform> find(const Object& object, const Frame& frame) override {
    const Trained& trained = models_.at(object.id);
    const std::vector<OrientedPoint> sampled = grid_sampled(frame.points, kSampling * object.diameter);
    const cv::Mat scene = to_mat(sampled);
    // Its own sampling takes cells relative to the scene's box, not to the model: make them as large as ours.
    Eigen::AlignedBox3f box;
    for (const OrientedPoint& point : sampled) box.extend(point.position);
    const double cell = kSampling * object.diameter / static_cast<double>(box.sizes().maxCoeff());
    std::vector<Pose3DPtr> poses;
    trained.detector->match(scene, poses, kReferences, cell);
    if (poses.empty()) return std::nullopt;
    poses.resize(std::min(poses.size(), kRefined));
    ICP(100, 0.005f, 2.5f, 8).registerModelToScene(trained.points, scene, poses);
    return to_transform(best(poses).pose);
  }

 private:
  struct Trained {
    cv::Mat points;
    std::unique_ptr<PPF3DDetector> detector;
  };

  /// The one that ICP left with the smallest residual among those with at least half of the most votes.
  static const cv::ppf_match_3d::Pose3D& best(const std::vector<Pose3DPtr>& poses) {
    const size_t most = poses.front()->numVotes;
    const Pose3DPtr* best = &poses.front();
    for (const Pose3DPtr& pose : poses) {
      if (2 * pose->numVotes >= most && pose->residual < (*best)->residual) best = &pose;
    }
    return **best;
  }

  static RigidTransform to_transform(const cv::Matx44d& pose) {
    RigidTransform transform = RigidTransform::Identity();
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column) transform.matrix()(row, column) = pose(row, column);
    }
    return transform;
  }

  std::map<int, Trained> models_;
};

}  // namespace

std::unique_ptr<Method> opencv_method() { return std::make_unique<OpenCv>(); }

}  // namespace edgepose::bench
