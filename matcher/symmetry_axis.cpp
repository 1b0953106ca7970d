#include "matcher/symmetry_axis.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "matcher/view_sphere.h"

namespace edgepose {
namespace {

constexpr double kPi = std::numbers::pi, kAxisDegree = kPi / 180;
constexpr double kEqualInertia = 0.04;  // relative difference of moments that count as equal
constexpr int kMaxParts = 24;
constexpr double kSmallestTurn = 10 * kAxisDegree;  // a refined turn by less has gone back to the start
// A part is real if turns by whole parts match clearly better than turns by whole and a half: about a
// prism of 12 sides, which no turn moves by much, the ratio is 0.1 for 12 parts and near 1 for 11 or 24.
constexpr float kClearlyBetter = 0.6f;
constexpr float kRound = 0.03f;  // no turn leaves more than this share off by more than a trifle
constexpr int kRoundTurns = 16;
constexpr double kGoldenTurn = 2.39996322972865332;  // its multiples never come close to a regular pattern

/// The axis of a turn: the point on it that is nearest to the centroid.
SymmetryAxis axis_of(const RigidTransform& motion, const Eigen::Vector3d& centroid) {
  const Eigen::AngleAxisd turn(motion.linear());
  const Eigen::Vector3d moved = motion * centroid - centroid;
  const Eigen::Vector3d across = moved - moved.dot(turn.axis()) * turn.axis();
  return {centroid + 0.5 * (across + turn.axis().cross(across) / std::tan(turn.angle() / 2)), turn.axis()};
}

double round_angle(int k) { return std::fmod(k * kGoldenTurn, 2 * kPi); }

}  // namespace

RigidTransform turn_about(const SymmetryAxis& axis, double angle) {
  RigidTransform t = RigidTransform::Identity();
  t.linear() = Eigen::AngleAxisd(angle, axis.direction).toRotationMatrix();
  t.translation() = axis.point - t.linear() * axis.point;
  return t;
}

std::vector<AxisGuess> guess_axes(const Eigen::Matrix3d& inertia) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
  const Eigen::Vector3d& moments = solver.eigenvalues();
  const Eigen::Matrix3d& axes = solver.eigenvectors();
  const auto equal = [&](int a, int b) {
    return std::abs(moments[a] - moments[b]) < kEqualInertia * moments[2];
  };
  // One turn of each prime order: every finite group has elements of prime order, and the parts about their
  // axes are counted afterwards. Turns of two, three or five parts lie within half a tooth of those of most
  // others.
  const std::vector<double> half = {kPi}, coarse = {kPi, 2 * kPi / 3, 2 * kPi / 5};
  std::vector<double> all;
  for (int prime : {2, 3, 5, 7, 11, 13, 17, 19, 23}) all.push_back(2 * kPi / prime);
  std::vector<AxisGuess> guesses;
  if (equal(0, 1) && equal(1, 2)) {
    for (int i = 0; i < 3; ++i) guesses.push_back({axes.col(i), all});
    const auto directions = view_directions(600);  // 8 degrees apart; the second half mirrors the first
    for (size_t i = 0; i < directions.size() / 2; ++i)
      guesses.push_back({directions[i].cast<double>().normalized(), coarse});
  } else if (equal(0, 1) || equal(1, 2)) {
    const int first = equal(0, 1) ? 0 : 1, other = equal(0, 1) ? 2 : 0;
    guesses.push_back({axes.col(other), all});
    for (int degrees = 0; degrees < 180; degrees += 3)
      guesses.push_back({std::cos(degrees * kAxisDegree) * axes.col(first) +
                             std::sin(degrees * kAxisDegree) * axes.col(first + 1),
                         half});
  } else {
    for (int i = 0; i < 3; ++i) guesses.push_back({axes.col(i), half});
  }
  return guesses;
}

std::optional<SymmetryAxis> find_axis(const SelfMatch& self, const Eigen::Vector3d& direction, double angle) {
  RigidTransform turn = turn_about({self.centroid(), direction}, angle);
  if (!self.refine(turn) || Eigen::AngleAxisd(turn.linear()).angle() < kSmallestTurn ||
      !self.distance(turn).is_match())
    return std::nullopt;
  return axis_of(turn, self.centroid());
}

Fold fold_about(const SelfMatch& self, const SymmetryAxis& axis) {
  const auto distance = [&](double angle) { return self.distance(turn_about(axis, angle)); };
  bool any_matches = true;
  float most_off = 0;
  for (int k = 1; k <= kRoundTurns && any_matches; ++k) {
    const SelfMatch::Distance d = distance(round_angle(k));
    any_matches = d.is_match();
    most_off = std::max(most_off, d.off);
  }
  if (any_matches && most_off < kRound) return {true, 1};
  for (int parts = kMaxParts; parts >= 2; --parts) {
    const double part = 2 * kPi / parts;
    float on = 0, between = 0;
    bool matches = true;
    for (int k = 1; k <= parts / 2 && matches; ++k) {
      const SelfMatch::Distance d = distance(k * part);
      matches = d.is_match();
      on += d.mean;
      if (matches) between += distance((k - 0.5) * part).mean;
    }
    if (matches && on < kClearlyBetter * between) return {false, parts};
  }
  return {any_matches, 1};
}

void refit_axis(const SelfMatch& self, const Fold& fold, SymmetryAxis& axis) {
  for (int round = 0; round < 2; ++round) {
    Eigen::Vector3d direction = Eigen::Vector3d::Zero(), point = direction;
    int used = 0;
    for (int k = 1; k <= 4; ++k) {
      // The nearer to half a turn, the better a turn shows its axis.
      const int parts = (fold.parts + 1) / 2 + k / 2 * (k % 2 ? 1 : -1);
      const double angle = fold.round ? (0.6 + 0.13 * k) * kPi : 2 * kPi * parts / fold.parts;
      const double sine = std::abs(std::sin(angle / 2));
      if (sine < 0.5) continue;
      RigidTransform turn = turn_about(axis, angle);
      if (!self.refine(turn) || !self.distance(turn).is_match()) continue;
      const SymmetryAxis fitted = axis_of(turn, self.centroid());
      direction += fitted.direction.dot(axis.direction) < 0 ? -fitted.direction : fitted.direction;
      point += fitted.point;
      ++used;
    }
    if (used == 0) return;
    axis = {point / used, direction.normalized()};
  }
}

}  // namespace edgepose
