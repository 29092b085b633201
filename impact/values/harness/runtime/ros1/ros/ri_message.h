// What generated messages of ROS 1 are made with.
#pragma once
#include <boost/array.hpp>
#include <boost/shared_ptr.hpp>
#include <ros/ri_time.h>
#include "ri_core.hpp"
