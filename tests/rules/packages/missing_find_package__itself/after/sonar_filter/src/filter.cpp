#include "sonar_filter/filter.hpp"

double filtered(double value) { return value; }
