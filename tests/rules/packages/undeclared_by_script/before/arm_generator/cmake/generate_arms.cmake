find_package(rmw REQUIRED)

function(generate_arms target)
  add_custom_target(${target}_arms)
endfunction()
