#ifndef BASE_LINK_BASE_LINK_H
#define BASE_LINK_BASE_LINK_H

#include <boost/date_time/posix_time/posix_time.hpp>
#include <boost/shared_ptr.hpp>
#include <gazebo/physics/physics.hh>
#include <urdf/model.h>

class BaseLink
{
public:
  explicit BaseLink(const urdf::Model& model);
#if GAZEBO_MAJOR_VERSION >= 9
  double angle(gazebo::physics::JointPtr joint) const { return joint->Position(0); }
#else
  double angle(gazebo::physics::JointPtr joint) const { return joint->GetAngle(0).Radian(); }
#endif

private:
  static constexpr double RATE = 12.5;
  urdf::LinkConstSharedPtr link_;
};

#endif
