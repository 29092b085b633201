#include <chrono>
#include <nav2_util/lifecycle_service_client.hpp>

int main()
{
  nav2_util::LifecycleServiceClient client("planner_server");
  return client.get_state(std::chrono::seconds(2));
}
