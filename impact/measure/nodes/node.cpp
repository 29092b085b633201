// A measuring node of roscpp: publishes or subscribes `rosimpact_measure/Sample`. What it prints is in __init__.py.
#include <ros/ros.h>
#include <ros/callback_queue.h>
#include <rosimpact_measure/Sample.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <map>
#include <string>
#include <thread>
#include <vector>

typedef rosimpact_measure::Sample Sample;

// The beginning of a sample: all that has to be read of a message that only arrives.
struct Arrival
{
  uint64_t number;
  int64_t sent;
  uint32_t publisher;
};

namespace ros
{
namespace message_traits
{
template <> struct MD5Sum<Arrival>
{
  static const char* value() { return "*"; }
  static const char* value(const Arrival&) { return "*"; }
};
template <> struct DataType<Arrival>
{
  static const char* value() { return "*"; }
  static const char* value(const Arrival&) { return "*"; }
};
template <> struct Definition<Arrival>
{
  static const char* value() { return ""; }
  static const char* value(const Arrival&) { return ""; }
};
}
namespace serialization
{
template <> struct Serializer<Arrival>
{
  template <typename Stream> static void read(Stream& stream, Arrival& message)
  {
    stream.next(message.number);
    stream.next(message.sent);
    stream.next(message.publisher);
  }
  template <typename Stream> static void write(Stream&, const Arrival&) {}
  static uint32_t serializedLength(const Arrival&) { return 20; }
};
}
}

static clockid_t clock_used = CLOCK_MONOTONIC;

static int64_t now()
{
  timespec time;
  clock_gettime(clock_used, &time);
  return time.tv_sec * 1000000000LL + time.tv_nsec;
}

static void sleep_until(int64_t when)
{
  timespec time;
  time.tv_sec = when / 1000000000LL;
  time.tv_nsec = when % 1000000000LL;
  while (clock_nanosleep(clock_used, TIMER_ABSTIME, &time, nullptr) == EINTR) {}
}

static void say(const std::string& text)
{
  std::cout << "measure:" << text << std::endl;
}

static std::atomic<int64_t> asked_start(0);
static std::atomic<bool> asked_end(false);

static void listen()
{
  std::string line;
  while (std::getline(std::cin, line))
  {
    if (line.compare(0, 6, "start ") == 0) asked_start = std::stoll(line.substr(6));
    if (line == "end") asked_end = true;
  }
  _exit(0);
}

static std::vector<Sample> load_contents(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  std::vector<Sample> samples;
  uint32_t size;
  while (file.read(reinterpret_cast<char*>(&size), 4))
  {
    std::vector<uint8_t> bytes(size + 1);
    file.read(reinterpret_cast<char*>(bytes.data()), size);
    Sample sample;
    ros::serialization::IStream stream(bytes.data(), size);
    ros::serialization::deserialize(stream, sample.content);
    samples.push_back(sample);
  }
  return samples;
}

typedef std::map<std::string, std::string> Options;

static long number_of(const Options& options, const std::string& name) { return std::stol(options.at(name)); }

static int publish(const Options& options)
{
  std::vector<Sample> samples = load_contents(options.at("contents"));
  const int64_t period = number_of(options, "period"), offset = number_of(options, "offset");
  const long count = number_of(options, "count");
  for (Sample& sample : samples) sample.publisher = number_of(options, "index");
  ros::NodeHandle node;
  ros::Publisher publisher = node.advertise<Sample>(options.at("topic"), number_of(options, "queue"));
  while (ros::ok() && publisher.getNumSubscribers() == 0) ros::WallDuration(0.01).sleep();
  say("ready");
  while (ros::ok() && asked_start == 0) ros::WallDuration(0.002).sleep();
  const int64_t start = asked_start + offset;
  long late = 0, number = 0;
  for (; number < count && ros::ok(); ++number)
  {
    const int64_t due = start + number * period;
    if (now() < due) sleep_until(due);
    Sample& sample = samples[number % samples.size()];
    sample.number = number;
    sample.sent = now();
    late += sample.sent > due + period;
    publisher.publish(sample);
  }
  std::cout << "measure:{\"published\": " << number << ", \"late\": " << late << ", \"elapsed\": " << now() - start
            << "}" << std::endl;
  while (ros::ok()) ros::WallDuration(0.1).sleep();
  return 0;
}

struct Record
{
  int64_t kind, publisher, number, sent, time;
};

static std::vector<Record> arrivals, callbacks;
static std::atomic<int64_t> last_arrival(0);
static int64_t work = 0;

static void on_arrival(const boost::shared_ptr<const Arrival>& message)
{
  const int64_t time = now();
  last_arrival = time;
  arrivals.push_back({0, message->publisher, static_cast<int64_t>(message->number), message->sent, time});
}

static void on_message(const Sample::ConstPtr& message)
{
  const int64_t time = now();
  callbacks.push_back({1, message->publisher, static_cast<int64_t>(message->number), message->sent, time});
  if (work > 0) sleep_until(time + work);
}

// Calls what is added at once, in the thread that reads the connection: before the subscriber's queue.
class AtOnce : public ros::CallbackQueueInterface
{
public:
  void addCallback(const ros::CallbackInterfacePtr& callback, uint64_t) override { callback->call(); }
  void removeByID(uint64_t) override {}
};

static int subscribe(const Options& options)
{
  work = number_of(options, "work");
  const int64_t idle = number_of(options, "idle"), longest = number_of(options, "longest");
  arrivals.reserve(1 << 20);
  callbacks.reserve(1 << 20);
  ros::NodeHandle node;
  ros::Subscriber subscriber = node.subscribe(options.at("topic"), number_of(options, "queue"), on_message);
  AtOnce at_once;
  ros::SubscribeOptions before;
  before.init<Arrival>(options.at("topic"), 0, on_arrival);
  before.callback_queue = &at_once;
  ros::Subscriber tap = node.subscribe(before);
  say("ready");
  int64_t ended = 0;
  while (ros::ok())
  {
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.02));
    if (!asked_end) continue;
    const int64_t time = now();
    if (ended == 0) ended = time;
    if (time - std::max(last_arrival.load(), ended) > idle || time - ended > longest) break;
  }
  tap.shutdown();
  subscriber.shutdown();
  std::ofstream file(options.at("output"), std::ios::binary);
  for (const std::vector<Record>* records : {&arrivals, &callbacks})
    file.write(reinterpret_cast<const char*>(records->data()), records->size() * sizeof(Record));
  file.close();
  say("done");
  return file.good() ? 0 : 1;
}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "measure", ros::init_options::AnonymousName | ros::init_options::NoSigintHandler);
  Options options;
  for (int place = 2; place < argc; ++place)
  {
    const std::string word = argv[place];
    options[word.substr(0, word.find('='))] = word.substr(word.find('=') + 1);
  }
  if (options["clock"] == "realtime") clock_used = CLOCK_REALTIME;
  std::thread(listen).detach();
  const int status = std::string(argv[1]) == "publish" ? publish(options) : subscribe(options);
  std::cout.flush();
  _exit(status);
}
