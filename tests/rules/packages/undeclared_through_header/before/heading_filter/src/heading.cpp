#include <tf2/utils.h>

int main() { return tf2::getYaw(tf2::Quaternion(0.0, 0.0, 0.0, 1.0)) > 1.0 ? 1 : 0; }
