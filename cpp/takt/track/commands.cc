#include "takt/track/commands.h"

#include "takt/track/texts.h"

namespace takt::track {

namespace {

template <typename T>
void DescribeEnds(Description<T>& d) {
  d.template required<&T::start_x>(unit::mm, kPlaces, "X of the start.");
  d.template required<&T::start_y>(unit::mm, kPlaces, "Y of the start.");
  d.template required<&T::end_x>(unit::mm, kPlaces, "X of the end.");
  d.template required<&T::end_y>(unit::mm, kPlaces, "Y of the end.");
}

template <typename T>
void DescribeReference(Description<T>& d) {
  d.template defaulted<&T::reference>(
      "Name of the part or coordinate system of the coordinates. Required with several coordinate systems, or with "
      "parts that can move.");
}

template <typename T>
void DescribePositions(Description<T>& d) {
  d.template defaulted<&T::this_position_index>(
      between(0, 1000),
      "Index of the position of this track's part for which the geometry is made; 0: the present one.");
  d.template defaulted<&T::other_position_index>(
      between(0, 1000),
      "Index of the position of the other track's part for which the geometry is made; 0: the present one.");
  d.template defaulted<&T::only_there>(
      "True: the link holds at these positions only. False: wherever the ends of the tracks meet.");
}

}  // namespace

void describe(Description<AppendLine>& d) {
  d.about("Appends a straight line. A gap before it is filled with a transition.");
  DescribeEnds(d);
  DescribeReference(d);
}

void describe(Description<AppendCircle>& d) {
  using C = AppendCircle;
  d.about(
      "Appends a circular arc, a full circle if it ends at its start. A gap before it is filled with a transition.");
  DescribeEnds(d);
  d.required<&C::center_x>(unit::mm, kPlaces, "X of the centre.");
  d.required<&C::center_y>(unit::mm, kPlaces, "Y of the centre.");
  d.defaulted<&C::clockwise>("True: clockwise; false: counterclockwise.");
  DescribeReference(d);
}

void describe(Description<AppendPosition>& d) {
  d.about("Appends a point that the track passes through. Its direction depends on the points before and behind it.");
  d.required<&AppendPosition::x>(unit::mm, kPlaces, "X of the point.");
  d.required<&AppendPosition::y>(unit::mm, kPlaces, "Y of the point.");
  DescribeReference(d);
}

void describe(Description<CloseLoop>& d) {
  d.about("Joins the end of the track to its start; nothing more can be appended.");
}

void describe(Description<Clear>& d) {
  d.about("Removes all geometry and links.");
}

void describe(Description<StartFromTrack>& d) {
  d.about("Makes the track start at the end of another one, whose geometry cannot be changed from then on.");
  d.required<&StartFromTrack::track>("Name of the other track.");
  DescribePositions(d);
}

void describe(Description<EndAtTrack>& d) {
  d.about("Makes the track end at the start of another one, whose geometry cannot be changed from then on.");
  d.required<&EndAtTrack::track>("Name of the other track.");
  DescribePositions(d);
}

void describe(Description<Enable>& d) {
  d.about("Makes the track usable by movers; done when it is Enabled. Pending changes of its geometry are made first.");
}

void describe(Description<Disable>& d) {
  d.about(
      "Makes the track unusable by movers; done when it is Disabled. Refused while movers move along it, join or leave "
      "it. After a fault: a reset leads to Disabled instead of Enabled.");
}

void describe(Description<Reset>& d) {
  d.about("Acknowledges a fault.");
}

void describe(Description<AddToGroup>& d) {
  d.named("AddTrackToGroup");
  d.about("Adds the track to a group of movers: while movers move along it, its area is reserved.");
  d.required<&AddToGroup::group>("Name of the group.");
}

void describe(Description<RemoveFromGroup>& d) {
  d.named("RemoveTrackFromGroup");
  d.about("Removes the track from its group, which then no longer reserves its area.");
}

void describe(Description<TrackMade>& d) {
  using C = TrackMade;
  d.about("Answer to a request to build a track.");
  d.required<&C::number>("Number of the request.");
  d.defaulted<&C::problem>("Why the track cannot be made.");
  d.defaulted<&C::element>("Element with the problem, from 1; 0: none.");
}

}  // namespace takt::track
