include("${arm_generator_DIR}/generate_arms.cmake")
