#pragma once
#include <optional>
#include <string>

namespace edgepose {

enum class ServoState {
  kIdle,         ///< nothing moves; how the program starts
  kArmed,        ///< nothing moves; go is allowed
  kApproaching,  ///< to the standoff before the entry, free
  kAxial,        ///< from the standoff to the entry along the axis, slowly
  kConverged,    ///< the tip touches the entry; nothing moves
  kStopped,      ///< slows to rest, or at rest, because somebody said stop
  kFault,        ///< slows to rest, or at rest, because something is wrong; the cause is kept
};
inline constexpr int kServoStates = 7;
const char* state_name(ServoState state);  ///< "idle", ...

/// What changes the state: the first four are commands, the others come from the loop.
enum class ServoEvent { kArm, kGo, kStop, kReset, kStandoffReached, kTouched, kFailed };
inline constexpr int kServoEvents = 7;
const char* event_name(ServoEvent event);  ///< "arm", ...

/// The state machine: where the event leads, or nothing if it is refused in this state. Pure.
///
///   state \ event  arm    go           stop     reset  standoff  touched    failed
///   idle           armed  -            idle     idle   -         -          fault
///   armed          -      approaching  stopped  idle   -         -          fault
///   approaching    -      -            stopped  -      axial     -          fault
///   axial          -      -            stopped  -      -         converged  fault
///   converged      -      -            stopped  idle   -         -          fault
///   stopped        -      -            stopped  idle   -         -          fault
///   fault          -      -            fault    idle   -         -          fault
///
/// So nothing moves without arm and go, and after a stop, a fault or an arrival nothing moves again without
/// reset, arm and go.
std::optional<ServoState> transition(ServoState state, ServoEvent event);

/// Whether the arm may be commanded to move towards a goal; in all other states it comes to rest, or is.
inline bool may_move(ServoState state) {
  return state == ServoState::kApproaching || state == ServoState::kAxial;
}

/// Why the loop went to kFault. What the bus and the drives find wrong is among them, so that one cause names
/// all.
enum class FaultCause {
  kNone,
  kPosesLost,    ///< no usable pose for too long
  kHalfTurn,     ///< the tool is nearly half a turn away from its goal: which way to turn is not defined
  kSingularity,  ///< the goal leads into a singularity, or is out of reach
  kJointLimit,   ///< the goal leads beyond a joint's limit
  kTimeout,      ///< the goal was not reached in time
  kFollowing,    ///< the arm is not where it was commanded to be
  kBadState,     ///< the arm's measured state is not finite, or too old
  kBus,          ///< the bus: lost, off, overloaded
  kDrive,        ///< a drive: fault, silence, wrong state
};
const char* fault_name(FaultCause cause);  ///< "poses lost", ...

}  // namespace edgepose
