#include <yaml-cpp/yaml.h>

int main() { return YAML::LoadFile("drive.yaml")["wheels"].as<int>() - 4; }
