#include <boost/thread/mutex.hpp>

int main()
{
  boost::mutex mutex;
  boost::mutex::scoped_lock lock(mutex);
  boost::reverse_lock<boost::mutex::scoped_lock> unlocked(lock);
}
