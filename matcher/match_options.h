#pragma once
#include <cstdint>
#include <string>

/// The options of each stage of match(). Lengths marked [d] are relative to the model's diameter. Each
/// check() returns what is wrong, starting with the field's name, or nothing.
namespace edgepose {

/// How the final pose is chosen among the candidates.
enum class Verification {
  kFreeSpace,  ///< ours: matches against free-space violations and edges, knows occlusion; can say "not here"
  kPaper,      ///< the paper's edge score S with two classes and early exit (Sec. 4.3.4); always gives a pose
  kSurfaceOverlap,  ///< share of model points near the scene (Papazov and Burschka), the paper's baseline
};

/// The multi-resolution, normal-clustered, edge-preserving down-sampling of the paper's Fig. 4. The grid is
/// about as fine as the model's sampling.
struct SamplingOptions {
  bool keep_edges = true;        ///< keep edge and high-curvature points; false = plain normal clusters
  float fine_theta_deg = 30;     ///< [degrees] normals closer than this merge in the fine grid ...
  float theta_factor = 0.45f;    ///< ... and the threshold is smaller by this factor in the coarse one
  int enough_points = 3000;      ///< a scene with no more points than this is not thinned further
  float max_pixel_size = 0.03f;  ///< [d] what is so far away that a pixel spans more is left out at first
  float max_noise = 0.012f;      ///< [d] what is measured worse than this is left out at first

  std::string check() const;
  bool operator==(const SamplingOptions&) const = default;
};

/// Which scene points vote, and what of it becomes a candidate (paper Sec. 3.2).
struct VotingOptions {
  float reference_share = 0.2f;  ///< share of the scene points used as reference points (paper: 1/5)
  int min_references = 224;  ///< but at least so many, as far as there are points (twice as many where more
                             ///< than one instance is looked for) ...
  int max_references = 600;  ///< ... and at most so many: large ones need fewer; time grows with it
  int peaks_per_reference = 4;  ///< best entries of each accumulator that become pose hypotheses
  float border = 0.2f;  ///< [bins] features this close to a bucket's border also vote in the next one; time
                        ///< grows with its 4th power

  std::string check() const;
};

/// Which hypotheses are averaged (paper Sec. 4.3.3).
struct ClusteringOptions {
  float max_distance = 0.1f;  ///< [d] between the model centres of any two poses of a cluster
  float max_angle_deg = 30;   ///< [degrees] between any two poses of a cluster

  std::string check() const;
};

/// How the default search goes through candidates; memory and results only depend on these and the seed.
struct SearchOptions {
  int batch = 32;             ///< references voted for before the next look at the candidates
  int coarse_candidates = 8;  ///< of each batch that are refined coarsely: by rank, and as many by surface
  int fine_candidates = 2;    ///< of these that are refined finely, likewise
  float sure_once = 0.95f;    ///< [0, 1] a candidate surer than this ends the search; above 1: never
  float sure_twice = 0.85f;   ///< the same for one that two batches led to, each by itself
  float sure_thrice = 0.75f;  ///< the same for three and more
  float settled = 6;  ///< the search also ends when two batches and more led to the best candidate and their
                      ///< number times its lead over every other pose is more than this, or there is no
                      ///< other; as the sure_*, only where one instance is looked for

  std::string check() const;
};

/// When surface counts as the same, for the default verification.
struct ToleranceOptions {
  float surface = 0.012f;          ///< [d] distance of matching surface without noise
  float noise_factor = 2;          ///< [sigma of the noise at that depth] added to it
  float max_surface = 0.03f;       ///< [d] but never more than this
  float min_normal_cosine = 0.6f;  ///< cosine of the angle between matching normals, at least
  float shallow_depth = 0.1f;      ///< [d] occluders in front by less are rarely another object

  std::string check() const;
};

/// ICP, coarse to fine, point to plane (paper Sec. 4.3.4, last step).
struct RefinementOptions {
  bool enabled = true;       ///< false: poses are reported as they were voted for and averaged
  int first_iterations = 3;  ///< before a voted pose is looked at
  int coarse_iterations = 6;
  int fine_iterations = 10;
  int last_iterations = 8;  ///< with every model point, of what is reported
  float outline_sigma = 4;  ///< [pixels] standard deviation of an outline correspondence

  std::string check() const;
};

/// The paper's verification, Eq. 2 and the steps below it.
struct PaperOptions {
  int candidates = 9;      ///< N: poses of each class that get the detailed score
  float roi_scale = 1.4f;  ///< s: size of the region of interest relative to the candidate's bounding box
  float accept_at_once = 0.7f;  ///< S above which the search ends
  float accept_best = 0.6f;     ///< S above which the best of a class is taken
  float edge_distance = 0.02f;  ///< [d] a scene edge point this close to the posed model matches
  bool two_classes = true;      ///< false: all candidates in one class (first of the three ways of Fig. 10)
  bool early_exit = true;       ///< false: score all 2N (second way)

  std::string check() const;
};

struct MatchOptions {
  Verification verification = Verification::kFreeSpace;
  SamplingOptions sampling;
  VotingOptions voting;
  ClusteringOptions clustering;
  SearchOptions search;
  ToleranceOptions tolerance;
  RefinementOptions refinement;
  PaperOptions paper;
  int max_instances = 1;       ///< how many instances of the model to look for
  float accept_score = 0.66f;  ///< [0, 1] detections with a lower score are reported as not accepted
  bool edge_score = false;     ///< also work out the paper's S of what is reported: about as much time as
                               ///< following a pose takes without it
  uint64_t seed = 1;           ///< of the choice of references
  int threads = 0;             ///< 0 = all cores; the result does not depend on it
  double max_seconds = 0;      ///< [s] after which the search ends with what it has; the result then depends
                               ///< on the machine's speed. 0 = no limit

  /// Of all stages; a stage's fields are named "voting.border".
  std::string check() const;
};

}  // namespace edgepose
