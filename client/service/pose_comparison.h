#pragma once
#include <map>
#include <string>
#include <vector>

#include "client/service/answer_log.h"

namespace edgepose {

/// How the poses of one model differ between two logs.
struct ModelComparison {
  size_t answers = 0;                         ///< pairs of answers about this model
  size_t poses = 0;                           ///< found in both
  size_t bit_equal = 0;                       ///< ... with the same bits
  size_t only_a = 0, only_b = 0;              ///< instances found in one of them only
  std::vector<double> translation, rotation;  ///< [m], [rad] of each pose found in both
};

struct Comparison {
  std::map<std::string, ModelComparison> models;
  size_t answers = 0;                       ///< pairs
  size_t only_a = 0, only_b = 0;            ///< answers without a partner
  size_t cut_short_a = 0, cut_short_b = 0;  ///< of the pairs: by the service's deadline

  bool nothing_missing() const;
  bool is_bit_equal() const;
  /// [m], [rad].
  bool is_within(double translation, double rotation) const;
};

/// Compares the answers of each camera; those of a camera in one log only have no partner. Instances of a
/// model are paired with the nearest. Of poses that look the same the one nearest in rotation counts.
Comparison compare_logs(const AnswerLog& a, const AnswerLog& b);

/// [rad] between the rotations.
double angle_between(const RigidTransform& a, const RigidTransform& b);

}  // namespace edgepose
