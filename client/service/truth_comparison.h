#pragma once
#include <map>
#include <string>
#include <vector>

#include "client/service/answer_log.h"
#include "evaluation/score.h"
#include "files/test_set.h"

namespace edgepose {

/// How well one object of a set was found.
struct TruthModel {
  double diameter = 0;                               ///< [m]
  bool symmetric = false;                            ///< the errors are ADI', else ADD
  size_t instances = 0;                              ///< in the images that were answered
  size_t extra = 0;                                  ///< poses where there is no such instance
  std::vector<double> translation, rotation, error;  ///< [m], [rad], [m] of each instance found

  /// Instances whose error is below `share` diameters.
  size_t within(double share) const;
};

struct TruthComparison {
  std::map<std::string, TruthModel> models;  ///< by the answers' names
  size_t answers = 0;                        ///< compared
  size_t unanswered = 0;                     ///< frames between the first and the last answer without one

  bool all_within(double share) const;
};

/// The images that were sent: all of a BOP set, or those of one scene of it (`folder`/../.. is the set then).
/// Throws InputError if it is neither.
TestSet read_truth(const std::filesystem::path& folder);

/// Compares the answers to the images of `set`, sent in their order, perhaps more than once. The frame of the
/// first image is the first that is in the log, else the first that was answered. A model belongs to the
/// object with its name, "obj_NNNNNN" included. Throws InputError if an answered model is no object of the
/// set.
TruthComparison compare_with_truth(const CameraAnswers& answers, const TestSet& set,
                                   const PoseErrors& errors);

}  // namespace edgepose
