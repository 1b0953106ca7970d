#include "matcher/clustering.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace edgepose {

float angle_between(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b) {
  const float cosine = (a.cwiseProduct(b).sum() - 1) / 2;  // trace(a^T b)
  return std::acos(std::clamp(cosine, -1.f, 1.f));
}

Eigen::Matrix3f mean_rotation(const std::vector<Eigen::Matrix3f>& rotations,
                              const std::vector<float>& weights) {
  Eigen::Matrix4d sum = Eigen::Matrix4d::Zero();
  for (size_t i = 0; i < rotations.size(); ++i) {
    const Eigen::Vector4d q = Eigen::Quaternionf(rotations[i]).normalized().coeffs().cast<double>();
    sum += static_cast<double>(weights[i]) * q * q.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(sum);
  const Eigen::Vector4d q = solver.eigenvectors().col(3);
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix().cast<float>();
}

std::vector<PoseHypothesis> cluster_poses(std::vector<PoseHypothesis> poses, const Model& model,
                                          const ClusteringOptions& options) {
  // Poses within half the limits of a cluster's first pose are within the limits of each other: complete
  // linkage without comparing all pairs.
  const float reach = options.max_distance / 2 * static_cast<float>(model.diameter());
  const float min_trace = 1 + 2 * std::cos(options.max_angle_deg / 2 * std::numbers::pi_v<float> / 180);
  const Eigen::Vector3f centre = model.centre().cast<float>();
  std::stable_sort(poses.begin(), poses.end(),
                   [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.votes > b.votes; });
  struct Group {
    Eigen::Matrix3f rotation;
    Eigen::Vector3f centre;
    std::vector<uint32_t> members;
  };
  std::vector<Group> groups;
  for (uint32_t i = 0; i < poses.size(); ++i) {
    if (poses[i].votes <= 0) continue;
    const Eigen::Vector3f at = poses[i].rotation * centre + poses[i].translation;
    const auto fits = [&](const Group& g) {
      return (g.centre - at).squaredNorm() < reach * reach &&
             g.rotation.cwiseProduct(poses[i].rotation).sum() > min_trace;
    };
    const auto group = std::find_if(groups.begin(), groups.end(), fits);
    if (group != groups.end())
      group->members.push_back(i);
    else
      groups.push_back({poses[i].rotation, at, {i}});
  }

  std::vector<PoseHypothesis> clusters;
  for (const Group& g : groups) {
    std::vector<Eigen::Matrix3f> rotations;
    std::vector<float> weights;
    Eigen::Vector3f centre_sum = Eigen::Vector3f::Zero();
    float votes = 0;
    for (uint32_t i : g.members) {
      rotations.push_back(poses[i].rotation);
      weights.push_back(poses[i].votes);
      centre_sum += poses[i].votes * (poses[i].rotation * centre + poses[i].translation);
      votes += poses[i].votes;
    }
    const Eigen::Matrix3f rotation = mean_rotation(rotations, weights);
    clusters.push_back({rotation, centre_sum / votes - rotation * centre, votes});
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const PoseHypothesis& a, const PoseHypothesis& b) { return a.votes > b.votes; });
  return clusters;
}

}  // namespace edgepose
