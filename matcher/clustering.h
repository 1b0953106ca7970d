#pragma once
#include <vector>

#include "matcher/voting.h"

namespace edgepose {

/// Groups like poses and averages each group: quaternion mean, votes added up (paper Sec. 4.3.3).
/// Sorted by votes, strongest first.
std::vector<PoseHypothesis> cluster_poses(std::vector<PoseHypothesis> poses, const Model& model,
                                          const ClusteringOptions& options);

/// The rotation whose quaternion is the dominant eigenvector of the weighted sum of q q^T
/// (Markley et al. 2007): no sign trouble, the same for any order.
Eigen::Matrix3f mean_rotation(const std::vector<Eigen::Matrix3f>& rotations,
                              const std::vector<float>& weights);

/// [rad] angle of the rotation between two rotations.
float angle_between(const Eigen::Matrix3f& a, const Eigen::Matrix3f& b);

}  // namespace edgepose
