#include <pcl/console/print.h>
#include <pcl/features/ppf.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/ppf_registration.h>

#include <cmath>
#include <map>

#include "bench/method.h"

namespace edgepose::bench {
namespace {

using Cloud = pcl::PointCloud<pcl::PointNormal>;

// Finer costs it minutes a model: its hash has 512 different values, so time grows with the step's -8th
// power.
constexpr double kSampling = 0.08;    // [d]
constexpr double kDistance = 0.05;    // [d]
constexpr double kAngleStepDeg = 12;  // as in its documentation
constexpr unsigned kReferenceEvery = 5;
constexpr double kClusterPosition = 0.1;  // [d]
constexpr double kClusterAngleDeg = 20;
constexpr size_t kModelPoints = 20000;

Cloud::Ptr to_cloud(const std::vector<OrientedPoint>& points) {
  Cloud::Ptr cloud(new Cloud);
  for (const OrientedPoint& point : points) {
    pcl::PointNormal p;
    p.getVector3fMap() = point.position;
    p.getNormalVector3fMap() = point.normal;
    cloud->push_back(p);
  }
  return cloud;
}

double radians(double degrees) { return degrees * M_PI / 180; }

class Pcl : public Method {
 public:
  Pcl() { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); }

  std::string name() const override { return "PCL PPFRegistration"; }
  std::string settings() const override {
    return "sampling 0.08 d, distance step 0.05 d, 12 degrees, every 5th scene point as reference, clusters "
           "of "
           "0.1 d and "
           "20 degrees, then PCL's point-to-point ICP within 0.05 d; 1 thread";
  }

  void train(const Object& object) override {
    Trained& trained = models_[object.id];
    const double step = kDistance * object.diameter;
    trained.points =
        to_cloud(grid_sampled(surface_points(object, kModelPoints), kSampling * object.diameter));
    pcl::PPFEstimation<pcl::PointNormal, pcl::PointNormal, pcl::PPFSignature> estimation;
    estimation.setInputCloud(trained.points);
    estimation.setInputNormals(trained.points);
    pcl::PointCloud<pcl::PPFSignature>::Ptr features(new pcl::PointCloud<pcl::PPFSignature>);
    estimation.compute(*features);
    trained.table.reset(
        new pcl::PPFHashMapSearch(static_cast<float>(radians(kAngleStepDeg)), static_cast<float>(step)));
    trained.table->setInputFeatureCloud(features);
  }

  std::optional<RigidTransform> find(const Object& object, const Frame& frame) override {
    const Trained& trained = models_.at(object.id);
    const Cloud::Ptr scene = to_cloud(grid_sampled(frame.points, kSampling * object.diameter));
    pcl::PPFRegistration<pcl::PointNormal, pcl::PointNormal> registration;
    registration.setSceneReferencePointSamplingRate(kReferenceEvery);
    registration.setPositionClusteringThreshold(static_cast<float>(kClusterPosition * object.diameter));
    registration.setRotationClusteringThreshold(static_cast<float>(radians(kClusterAngleDeg)));
    registration.setSearchMethod(trained.table);
    registration.setInputSource(trained.points);
    registration.setInputTarget(scene);
    Cloud aligned;
    registration.align(aligned);

    pcl::IterativeClosestPoint<pcl::PointNormal, pcl::PointNormal> icp;
    icp.setInputSource(trained.points);
    icp.setInputTarget(scene);
    icp.setMaxCorrespondenceDistance(kDistance * object.diameter);
    icp.setMaximumIterations(30);
    icp.align(aligned, registration.getFinalTransformation());
    const Eigen::Matrix4f pose =
        icp.hasConverged() ? icp.getFinalTransformation() : registration.getFinalTransformation();
    return RigidTransform(pose.cast<double>());
  }

 private:
  struct Trained {
    Cloud::Ptr points;
    pcl::PPFHashMapSearch::Ptr table;
  };
  std::map<int, Trained> models_;
};

}  // namespace

std::unique_ptr<Method> pcl_method() { return std::make_unique<Pcl>(); }

}  // namespace edgepose::bench
