#include "takt/track/commands.h"

#include "takt/track/texts.h"

namespace takt::track {

namespace {

template <typename T>
void DescribeEnds(Description<T>& d) {
  d.template required<&T::start_x>(unit::mm, kPlaces, "X of where it begins.");
  d.template required<&T::start_y>(unit::mm, kPlaces, "Y of it.");
  d.template required<&T::end_x>(unit::mm, kPlaces, "X of where it ends.");
  d.template required<&T::end_y>(unit::mm, kPlaces, "Y of it.");
}

template <typename T>
void DescribeReference(Description<T>& d) {
  d.template defaulted<&T::reference>(
      "Name of the part or coordinate system that the places belong to; needed where there are several coordinate "
      "systems or parts that move.");
}

template <typename T>
void DescribePositions(Description<T>& d) {
  d.template defaulted<&T::this_position_index>(
      between(0, 1000), "Index of the position of this track's part that this is meant for; 0: where it is.");
  d.template defaulted<&T::other_position_index>(between(0, 1000), "The same of the other track's part.");
  d.template defaulted<&T::only_there>("True: the tracks are linked there alone. False: wherever they meet.");
}

}  // namespace

void describe(Description<AppendLine>& d) {
  d.about("Appends a straight line. A gap before it is filled with a transition.");
  DescribeEnds(d);
  DescribeReference(d);
}

void describe(Description<AppendCircle>& d) {
  using C = AppendCircle;
  d.about("Appends a circular arc, a whole circle if it ends where it starts. A gap before it is filled.");
  DescribeEnds(d);
  d.required<&C::center_x>(unit::mm, kPlaces, "X of its centre.");
  d.required<&C::center_y>(unit::mm, kPlaces, "Y of it.");
  d.defaulted<&C::clockwise>("Which way round.");
  DescribeReference(d);
}

void describe(Description<AppendPosition>& d) {
  d.about("Appends a place to go through. Its direction depends on the places before and behind it.");
  d.required<&AppendPosition::x>(unit::mm, kPlaces, "X of it.");
  d.required<&AppendPosition::y>(unit::mm, kPlaces, "Y of it.");
  DescribeReference(d);
}

void describe(Description<CloseLoop>& d) {
  d.about("Lets the track go on from its end to its start; nothing can be appended any more.");
}

void describe(Description<Clear>& d) {
  d.about("Takes all geometry and links away.");
}

void describe(Description<StartFromTrack>& d) {
  d.about("Lets the track start where another one ends. The geometry of that one stays as it is from now on.");
  d.required<&StartFromTrack::track>("Name of the other track.");
  DescribePositions(d);
}

void describe(Description<EndAtTrack>& d) {
  d.about("Lets the track end where another one starts. The geometry of that one stays as it is from now on.");
  d.required<&EndAtTrack::track>("Name of the other track.");
  DescribePositions(d);
}

void describe(Description<Enable>& d) {
  d.about("Lets movers use the track; done when it is Enabled. What was appended before is made first.");
}

void describe(Description<Disable>& d) {
  d.about(
      "Keeps movers from using the track; done when it is Disabled. After a fault: a reset leads to Disabled instead "
      "of Enabled.");
}

void describe(Description<Reset>& d) {
  d.about("Acknowledges a fault.");
}

void describe(Description<AddToGroup>& d) {
  d.named("AddTrackToGroup");
  d.about("Puts the track into a group of movers: while movers move along it, it keeps its area.");
  d.required<&AddToGroup::group>("Name of the group.");
}

void describe(Description<RemoveFromGroup>& d) {
  d.named("RemoveTrackFromGroup");
  d.about("Takes the track out of its group: nobody looks any more what its movers collide with.");
}

void describe(Description<TrackMade>& d) {
  using C = TrackMade;
  d.about("Tells whether a track could be made.");
  d.required<&C::number>("Of the question.");
  d.defaulted<&C::problem>("Why it cannot be so.");
  d.defaulted<&C::element>("Where, from 1; 0: nowhere.");
}

}  // namespace takt::track
