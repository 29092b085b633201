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
  double angle(gazebo::physics::JointPtr joint) const { return joint->GetAngle(0).Radian(); }

private:
  static const double RATE = 12.5;
  boost::shared_ptr<const urdf::Link> link_;
};

#endif
