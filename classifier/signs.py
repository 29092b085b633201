"""The signs that people of the field look for in a report, label by label as in the labelling guide, corpus/GUIDE.md.

A sign is a pattern on the text in lower case, or a small vocabulary of which any form of a word counts. Where says in
which parts it is sought: `t` the title, `p` title and prose together, `c` code and logs, `a` all of these at once; each
place is a feature of its own.
"""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Sequence
from itertools import islice

from ..corpus.distros import DISTROS, ROS1, ROS2
from .text import PLATFORMS, Parts, list_general_words

_PROSE = 2_500
_LOG = 2_000
LIMIT = 4.0
"""Standard deviations beyond which a sign is no stronger."""
_MOST = 8
"""Occurrences that are counted: more say nothing more."""

_DISTRO = rf"(?:{'|'.join(DISTROS)})"
_PLATFORM = rf"(?:{'|'.join(PLATFORMS)}|os ?x|mac os|arch linux|visual studio)"
_LIBRARY = (
    r"(?:opencv|boost|pcl|eigen|qt|cmake|gcc|g\+\+|clang|python|ogre|vtk|gazebo|ubuntu|numpy"
    r"|protobuf|tinyxml|yaml-?cpp|"
    r"llvm|sip|pyqt|pyside|kernel|osg|bullet|fcl|octomap|gtsam|ceres|urdfdom|console_bridge|poco|asio|libusb|cuda|"
    r"jsoncpp|fmt|spdlog|lua|java|msvc|matplotlib|setuptools|pip|sphinx|empy|pyyaml|mavlink|px4|ardupilot|firmware|"
    r"ignition|sdk|librealsense|openni|ffmpeg|assimp|rviz|moveit)"
)

_UPDATE = (
    ("distro", rf"\b{_DISTRO}\b", "tpc"),
    ("ROS 1 distro", rf"\b(?:{'|'.join(ROS1)})\b", "a"),
    ("ROS 2", rf"\b(?:{'|'.join(ROS2)})\b|\bros ?2\b", "a"),
    ("platform", rf"\b{_PLATFORM}\b", "tp"),
    ("on a distro", rf"\b(?:on|in|for|under|with|to|from|since|until) (?:ros[ -]?2? ?)?(?:the )?{_DISTRO}\b", "tp"),
    (
        "fails on a distro",
        r"(?:fail|error|broken|break|not (?:work|build|compil)|n'?t (?:work|build|compil)|cannot|can'?t|crash)"
        rf"[^.\n]{{0,60}}\b(?:on|in|for|under|with) (?:ros[ -]?2? ?)?{_DISTRO}",
        "tp",
    ),
    (
        "two distros compared",
        rf"\b{_DISTRO}\b[^.\n]{{0,60}}\b(?:but|while|whereas|works?|worked|than|vs|to|and"
        rf"|from)\b[^.\n]{{0,60}}\b{_DISTRO}\b",
        "tp",
    ),
    ("upgrade", r"\b(?:upgrad|updat)(?:e|ed|es|ing)\b", "tp"),
    (
        "after an upgrade",
        r"\b(?:after|since|with|by|when|following|due to|because of)\b[^.\n]{0,30}"
        r"\b(?:upgrad|updat|migrat|sync|new(?:er|est)? (?:version|release))",
        "tp",
    ),
    (
        "worked before",
        r"\b(?:used to|previously|worked (?:fine|well|before|in|on|with|until|perfectly)|was working"
        r"|no longer|any ?more"
        rf"|works? (?:fine |well |ok )?(?:on|in|with|under) (?:ros )?(?:the )?(?:previous|old|\w+ ?\d|{_DISTRO})"
        r"|stopped working|before the)",
        "tp",
    ),
    ("no longer", r"\bno longer|any ?more\b|stopped work", "tp"),
    (
        "since a version",
        r"\b(?:since|as of|starting (?:with|from)|from version|until)\b[^.\n]{0,25}"
        rf"(?:\d+\.\d+|{_DISTRO}|version|release|commit|update)",
        "tp",
    ),
    (
        "new version",
        r"\b(?:new(?:er)?|latest|recent|later|newest|current) (?:\w+ )?"
        r"(?:version|release|update|api|gcc|boost|opencv|compiler|ubuntu|cmake|python|ogre|kernel|firmware|change)s?",
        "tp",
    ),
    (
        "old version",
        r"\b(?:old(?:er)?|previous|earlier|outdated|former) (?:\w+ )?"
        r"(?:version|release|api|distro|package|firmware|gcc|cmake)s?",
        "tp",
    ),
    ("version word", r"\bversions?\b", "tp"),
    ("version number", r"\bv?\d+\.\d+(?:\.\d+)+\b", "tp"),
    ("library with version", rf"\b{_LIBRARY}[ _-]?(?:version |v|>=? ?|= ?)?\d+(?:\.\d+){{0,3}}", "tpc"),
    ("Qt generation", r"\bqt ?[456]\b|pyqt[456]|pyside[26]?", "a"),
    ("Python 3", r"\bpython ?3(?:\.\d+)?\b|\bpy3k?\b|python 2 (?:and|to|vs)|2to3|python2", "a"),
    (
        "Python 2 code",
        r"print statement|missing parentheses|has_key|iteritems|basestring|xrange|unicode'? is not defined|raw_input"
        r"|stringio|configparser|bytes-like|'str' does not support|must be str, not|dict_keys"
        r"|__metaclass__|cpickle|urllib2"
        r"|invalid token|taberror|syntaxerror",
        "a",
    ),
    (
        "C++ standard",
        r"c\+\+ ?-?(?:0x|11|14|17|20|23)\b|-std="
        r"|std::(?:make_unique|optional|filesystem|tr1|binary_function|auto_ptr|random_shuffle|bind1st|mem_fun)",
        "a",
    ),
    ("compiler", r"\b(?:gcc|g\+\+|clang|msvc|llvm|compiler)\b", "tp"),
    ("OpenCV generation", r"\bcv_(?!bridge)[a-z]\w{3,}|iplimage|cvcvt|opencv ?[2345]\b", "a"),
    ("OpenCV", r"opencv|cv_bridge", "a"),
    ("deprecated", r"\bdeprecat\w+", "tpc"),
    (
        "removed or renamed",
        r"\b(?:removed|dropped|renamed|moved to|replaced|relocated|split|obsolete|end of life|eol|superseded)\b",
        "tp",
    ),
    ("compatible", r"backwards?[- ]compat|\bcompatib|incompatib", "tp"),
    (
        "API change",
        r"\bapi (?:break|chang)|\babi\b|soname|breaking change|interface change|changed (?:in|since|between)"
        r"|changes? (?:in|to|of) (?:the )?(?:api|upstream|gcc|boost)"
        r"|changed (?:its|the|their) (?:api|name|signature|interface|return|default)",
        "tp",
    ),
    ("regression", r"\bregress", "tp"),
    ("port", r"\b(?:migrat|port)(?:e|ed|ing|ion)?\b (?:\w+ ){0,3}(?:to|for|from)\b", "tp"),
    (
        "support for a version",
        r"\b(?:support|fix(?:es)?|compil\w*|build\w*|compatib\w*|work\w*) (?:for |on |with |in |under |against )+"
        rf"(?:ros[ -]?2? ?)?(?:{_DISTRO}|{_PLATFORM}|gcc|g\+\+|clang|c\+\+|boost|opencv|python|qt"
        rf"|cmake|eigen|pcl|gazebo)",
        "tp",
    ),
    ("undefined symbol", r"undefined symbol|symbol lookup error|undefined reference|unresolved external", "a"),
    ("symbol lookup", r"undefined symbol|symbol lookup error", "a"),
    (
        "shared library not loaded",
        r"error while loading shared libraries|cannot open shared object|library not loaded|image not found",
        "a",
    ),
    ("library file version", r"\.so\.\d+", "a"),
    ("commit named", r"git bisect|\bcommit [0-9a-f]{7,40}|\b[0-9a-f]{40}\b", "p"),
    ("reverted", r"\brevert|downgrad|roll(?:ed|ing)? back", "p"),
    ("apt upgrade", r"apt(?:-get)? (?:dist-)?upgrade|apt(?:-get)? update", "a"),
    (
        "apt cannot satisfy",
        r"dpkg: error|trying to overwrite|unmet dependenc|held broken|not going to be install"
        r"|not installable|broken packages",
        "a",
    ),
    ("firmware", r"\bfirmware|\bsdk\b|px4|ardupilot|\bdriver version", "tp"),
    ("build farm", r"build ?farm|jenkins|build\.ros|devel job|binarydeb|sourcedeb|travis|\bci\b|prerelease", "a"),
    ("CMake policy", r"cmp0\d+|cmake_minimum_required|\bpolicy", "a"),
)

_BUILD = (
    ("compiler error", r"\berror:|fatal error:|\berror c\d{4}", "a"),
    (
        "name not declared",
        r"was not declared in this scope|has no member|is not a member of|does not name a type|no matching function"
        r"|invalid conversion|cannot convert|no type named|undeclared identifier|ambiguous|expected .{1,20} before"
        r"|no member named|call of overloaded|conflicting declaration|static assertion|deleted function",
        "a",
    ),
    ("no such file", r"no such file or directory|file not found", "a"),
    ("header not found", r"\.h(?:pp|xx)?['\":>]?:? ?(?:no such file|file not found)|fatal error: \S{1,100}\.h", "a"),
    ("generated header", r"(?:fatal error|error): \w+/\w+\.h\w*:? no such|#include \S{1,60}_msgs/\w+\.h", "a"),
    ("std::", r"\bstd::\w+", "a"),
    ("Boost", r"\bboost\b", "tpc"),
    ("warning", r"-werror|\bwarning:", "a"),
    ("make failed", r"make(?:\[\d\])?: \*\*\*|ninja: build stopped|failed\s{1,4}<<<|aborted\s{1,4}<<<", "a"),
    ("linker", r"/usr/bin/ld|cannot find -l|ld returned|\blinker\b|\blink(?:ing|ed)\b|dso missing|as-needed", "a"),
    ("build", r"\b(?:build|compil|catkin_make|colcon|rosmake|catkin build)\w*", "tp"),
    (
        "build fails",
        r"\b(?:build|compil)\w*\b[^.\n]{0,30}(?:fail|error|break|broke)"
        r"|(?:fail|error|not|n't|unable)\w*\b[^.\n]{0,25}\b(?:build|compil)",
        "tp",
    ),
    (
        "install fails",
        r"install\w*[^.\n]{0,30}(?:fail|error)|(?:fail|error|not|n't|unable)\w*\b[^.\n]{0,25}\binstall",
        "tp",
    ),
)

_DEPENDENCY = (
    ("CMake", r"\bcmake\b|cmakelists", "tpc"),
    ("CMake error", r"cmake error", "a"),
    ("find_package", r"find_package|pkg_check_modules|pkg-config|find_library", "tpc"),
    (
        "could not find",
        r"could ?n[o']t find|by not providing|unable to find|required by .{1,40} not found|none of the required",
        "a",
    ),
    ("no configuration file", r"could not find a (?:package )?configuration file|configuration file provided by", "a"),
    ("manifest", r"package\.xml|manifest\.xml|stack\.xml|setup\.py|debian/control|\.rosinstall|metapackage", "tpc"),
    (
        "depend tag",
        r"</?(?:build_|run_|exec_|test_|buildtool_|build_export_|doc_)?depend\b"
        r"|\b(?:build|run|exec|test|buildtool)_?-?depend\w*",
        "tpc",
    ),
    ("depend", r"\bdepend(?:s|ency|encies|ing|ed)?\b", "tpc"),
    (
        "dependency missing",
        r"(?:missing|undeclared|add(?:ed|s|ing)?|lack\w*|needs?|required|forgot\w*|unmet|not (?:listed"
        r"|declared|specified)"
        r"|without|no)\b[^.\n]{0,35}\bdepend",
        "tp",
    ),
    (
        "dependency not there",
        r"\bdepend\w*[^.\n]{0,35}(?:missing|undeclared|lack|wrong|unneeded|unnecessary|unused|circular|superfluous|cycl"
        r"|not (?:found|declared|listed|installed|available|satisfied|resolv|be ))",
        "tp",
    ),
    (
        "dependency superfluous",
        r"(?:remove|drop|circular|cyclic|unnecessary|unneeded|unused|superfluous|wrong|spurious|extra"
        r"|duplicate|redundant"
        r"|useless|obsolete)\w*\b[^.\n]{0,30}\bdepend",
        "tp",
    ),
    (
        "should depend",
        r"(?:should|must|needs? to|does(?: not|n't)|do(?: not|n't)) depend"
        r"|(?:add|added) (?:as|to) (?:a |the )?(?:run|build|exec|test|package)",
        "tp",
    ),
    ("rosdep", r"\brosdep\b", "tpc"),
    (
        "rosdep key",
        r"rosdep (?:key|definition|rule|entry|entries)s?|cannot be resolved|no definition of|not been resolved"
        r"|no rosdep rule|could not be resolved|could not have their|unresolved|resolve",
        "a",
    ),
    (
        "package not located",
        r"unable to locate package|couldn'?t find any package|has no installation candidate|no candidate"
        r"|package .{1,40} (?:is )?not available|no package .{1,30} available",
        "a",
    ),
    (
        "not released",
        r"\b(?:not|n't|never|un)[ -]?(?:yet )?(?:been )?releas|release (?:\S{1,30} ){0,4}(?:into|for"
        r"|to|on)\b|bloom|no binar"
        r"|not (?:yet )?(?:in|available) (?:in|on|from|for|via|through)|deb packages?|debian package",
        "tp",
    ),
    ("apt", r"apt(?:-get)? install|\bapt\b", "a"),
    ("ROS binary package", rf"\bros-{_DISTRO}-[\w-]+", "a"),
    ("import error", r"no module named|modulenotfounderror|importerror|cannot import name|can'?t import", "a"),
    ("no module named", r"no module named", "a"),
    ("attribute gone", r"cannot import name|has no attribute|attributeerror", "a"),
    (
        "package not found",
        r"\b(?:package|resource|stack)\b[^.\n]{0,40}not found|resourcenotfound|rospack|packagenotfound|cannot locate"
        r"|package '[^'\n]{1,60}' not|cannot load message|invalid roslaunch",
        "a",
    ),
    (
        "build macro",
        r"catkin_package|catkin_depends|ament_target_dependencies|ament_export|target_link_libraries"
        r"|include_directories"
        r"|catkin_include|catkin_libraries|ament_package|rosidl_",
        "tpc",
    ),
    (
        "build order",
        r"add_dependencies|_gencpp|_generate_messages|exported_targets|generate_messages|message_generation|_gencfg"
        r"|generated (?:header|message|file)|before (?:it is|they are|being) (?:built|generated)|build order"
        r"|parallel (?:build|make)|\b-j ?\d",
        "a",
    ),
    ("missing", r"\bmissing\b", "tpc"),
    (
        "missing package",
        r"\bmissing (?:\w+ ){0,2}(?:package|dependenc|include|library|header|module|key|find_package|import|lib\w+)",
        "tp",
    ),
    (
        "not installed",
        r"not (?:be |get |getting )?install|isn'?t installed|install(?:ing|ed)? (?:it )?manually"
        r"|(?:need to|has to be|have to|had to) install",
        "tp",
    ),
    ("require", r"\brequire[sd]?\b", "tp"),
    ("library package", r"\b(?:python|lib|ros)-[\w-]+", "tpc"),
    ("export", r"\bexport(?:s|ed|ing)?\b", "p"),
    ("pip", r"\bpip3? install|\bpypi\b|virtualenv|\bpip\b", "a"),
    ("bundled", r"\bvendor|submodule|bundl|third[- ]party|3rdparty|git clone", "p"),
    ("rosdistro", r"rosdistro|distribution\.yaml|base\.yaml|-release\b", "a"),
    (
        "install rule",
        r"install\((?:targets|files|directory|programs)|install (?:rule|target|space|step|folder|dir)"
        r"|catkin_package_\w+_destination",
        "a",
    ),
)

_INCONSISTENCY = (
    ("frame", r"\bframe(?:_id|s)?\b", "tpc"),
    (
        "frame id",
        r"frame_?id|child_frame|header\.frame|fixed frame|target frame|base_link|base_footprint|\bodom\b",
        "tpc",
    ),
    ("tf", r"\btf2?\b|transform(?:s|ation|ed)?\b|lookuptransform", "tpc"),
    (
        "tf error",
        r"lookup would require|extrapolation|could not transform|no transform|does not exist|passed to lookup"
        r"|not part of the same tree|unconnected|can ?not find (?:transform|frame)|tf_repeated|tf_old|unknown frame"
        r"|timed? ?out waiting for transform",
        "a",
    ),
    (
        "stamp",
        r"\btime ?-?stamps?\b|\bstamp(?:s|ed)?\b|header\.stamp|sim_?time|\bclock\b|ros::time"
        r"|rospy\.time|time sync|\bntp\b"
        r"|time jump|epoch",
        "tpc",
    ),
    (
        "unit",
        r"\b(?:units?|degrees?|radians?|rad/s|deg/s|m/s|met(?:er|re)s?|millimet\w+|mm|cm|gauss|tesla|celsius|kelvin"
        r"|percent\w*|volts?|enu|ned|conversion|scal(?:e|ed|ing)|factor|sign|flipp\w*|invert\w*"
        r"|negative|swapp\w*|mirror\w*)\b",
        "tp",
    ),
    ("REP", r"\brep[ -]?\d+", "a"),
    ("NaN or not normalised", r"\bnans?\b|\binf(?:inity)?\b|not a number|quaternion|normali[sz]ed|covariance", "tpc"),
    (
        "encoding",
        r"\bencodings?\b|\brgb8?\b|\bbgr8?\b|mono8|mono16|16uc1|32fc1|8uc\d|yuv\w*|bayer|endian|byte order|depth image",
        "tpc",
    ),
    (
        "wrong value",
        r"\b(?:wrong|incorrect|invalid|bad|unexpected|bogus|zero|garbage|strange|inconsistent|mismatch\w*|always|empty"
        r"|constant|false)\b[^.\n]{0,30}\b(?:value|data|unit|frame|stamp|time|range|order|sign"
        r"|orientation|pose|position"
        r"|field|topic|type|name|message|velocity|header|size|axis|axes|reading|covariance|joint)",
        "tp",
    ),
    ("field", r"\bfields?\b|\bheader\b|\bpointcloud2?\b|\bintensity\b|\bring\b", "tp"),
    (
        "mismatch",
        r"mis-?match|(?:does|do)(?: not|n't) match|not match|inconsisten|disagree|out of sync|conflict",
        "tp",
    ),
    ("md5", r"md5 ?sum|\bmd5\b|checksum|type hash|datatype", "a"),
    (
        "types refused",
        r"client \[.{1,60}\] wants topic|wants (?:topic|service)|to have datatype|dropping connection",
        "a",
    ),
    (
        "message definition",
        r"message definition|\.msg\b|\.srv\b|message type|msg type|\bmsgs?\b|service type|unknown (?:message|type)"
        r"|deseriali[sz]|unpack|seriali[sz]|could not process inbound",
        "tpc",
    ),
    (
        "QoS",
        r"\bqos\b|best[_ ]effort|\breliab\w+|durability|transient[_ ]local|incompatible (?:qos|policy)|sensor_?data",
        "a",
    ),
    ("topic", r"\btopics?\b", "tp"),
    ("topic name", r"(?:^|[\s`'\"(])/[a-z_]\w*(?:/\w+)*", "tp"),
    (
        "namespace",
        r"\bnamespaces?\b|\bremap\w*|tf_prefix|\bprefix\b|\bns=|leading slash|\brelative|private name|\babsolute",
        "tpc",
    ),
    ("subscribe", r"\bsubscri\w+|\bsub\b|\blisten\w+|\bcallback", "tp"),
    (
        "receive",
        r"\b(?:receiv\w+|recv|get(?:s|ting)?|sends?|sent|sending)\b[^.\n]{0,25}"
        r"\b(?:message|data|msg|topic|callback|command|image|scan)",
        "tp",
    ),
    (
        "not received",
        r"(?:not|n't|never|no|nothing|cannot|unable to|fail\w*)\b[^.\n]{0,25}"
        r"\b(?:receiv\w*|recv|subscrib\w*|arriv\w*|connect\w*|communicat\w*|visible|see|heard)",
        "tp",
    ),
    (
        "network",
        r"ros_master_uri|ros_ip|ros_hostname|ros_domain_id|\bhostname|multi-?cast|firewall|\bport\b|\bdocker\b"
        r"|two (?:machines|computers)|remote (?:machine|pc)|\bnetwork\b|\bwi-?fi\b|\bdds\b|fastrtps"
        r"|fastdds|cyclone|\brmw",
        "tpc",
    ),
    ("rosserial", r"rosserial|lost sync|\bbaud|arduino|serial port", "a"),
    ("joint", r"\bjoint(?:s|_states?|_names?)?\b", "tp"),
    ("interface package", r"\b\w+_msgs\b", "tp"),
    (
        "interface",
        r"\b(?:laserscan|pointcloud2?|camerainfo|imu|odometry|jointstate|twist|posestamped|navsatfix|joy|marker"
        r"|occupancygrid|batterystate|tfmessage|jointtrajectory|magneticfield|compressedimage|goalstatus)\b",
        "tp",
    ),
    (
        "axis",
        r"\b(?:x|y|z|roll|pitch|yaw)\b[ -/]{0,3}(?:axis|axes|direction)|\baxis\b|\baxes\b"
        r"|right[- ]hand|orientation|heading"
        r"|coordinate",
        "tp",
    ),
    ("topic tool", r"rostopic|ros2 topic|topic (?:echo|list|hz)|rqt_graph|rosnode|\becho\b", "a"),
    (
        "expected",
        r"expected (?:behaviou?r|result|value|to)|expects?\b|actual (?:behaviou?r|result)|instead of"
        r"|should be (?:in|the|published|set|a)\b",
        "tp",
    ),
    (
        "range",
        r"out of (?:range|bounds)|range_m(?:in|ax)|\blimits?|saturat|clamp|overflow|underflow|angle_m(?:in|ax)",
        "tp",
    ),
)

_LOGIC = (
    ("publish", r"\bpublish\w*|\badvertis\w+|\bpub\b", "tp"),
    (
        "publishes never or always",
        r"(?:no longer|never|not|n't|stops?|stopped|only|fails? to|without|nothing|keeps?|continu\w+"
        r"|still|always|start\w*"
        r"|stop|cease\w*|doesnt)\b[^.\n]{0,25}\b(?:publish\w*|advertis\w*|sen[dt]\w*|emit\w*|broadcast\w*)",
        "tp",
    ),
    (
        "condition and publish",
        r"(?:no longer|never|not|n't|stops?|stopped|only|fails? to|keeps?|continu\w+|always|start\w*"
        r"|unless|until|once|when"
        r"|if|stale|old|repeat)\b.{0,40}\b(?:publish|advertis|broadcast|republish|topic|message)",
        "t",
    ),
    (
        "publish under a condition",
        r"\b(?:publish\w*|sen[dt]\w*|emit\w*|broadcast\w*|messages?)\b[^.\n]{0,40}\b(?:only|once|when"
        r"|until|unless|after"
        r"|before|if|even|twice|too|every|continuous\w*|immediately|again|periodic\w*|stale|old"
        r"|duplicat\w*|repeat\w*|delay\w*"
        r"|late|early)\b",
        "tp",
    ),
    ("latched", r"\blatch\w*|transient[_ ]local|late[- ]join|\bcached?\b|keep_last", "tp"),
    (
        "first or lost message",
        r"\b(?:first|initial|last|some|lost|drop\w*|miss\w*|duplicate\w*|old|stale|outdated|skipp\w*"
        r"|queued)\b[^.\n]{0,20}"
        r"\b(?:messages?|msgs?|publish\w*|samples?|data|scans?|images?|transforms?)\b",
        "tp",
    ),
    (
        "rate",
        r"\b(?:rate|hz|frequency|frequent\w*|fps|period\w*|slow\w*|too (?:often|fast|slow|early|late|seldom))\b",
        "tp",
    ),
    (
        "rate of a topic",
        r"(?:publish\w*|topic|message|odom\w*|tf|scan|imu|joint_states?)\b[^.\n]{0,40}\b(?:\d+ ?hz|rate|frequency)"
        r"|(?:rate|frequency|hz)\b[^.\n]{0,40}\b(?:publish|topic|message)",
        "tp",
    ),
    ("published again", r"\bre-?publish|re-?sen[dt]|throttl|\bqueue", "tp"),
    (
        "topic silent",
        r"(?:topics?|echo|subscri\w+)\b[^.\n]{0,50}"
        r"\b(?:nothing|empty|no (?:data|message|output|msg)|silent|not (?:publish|updat|receiv)|no new"
        r"|not being|never)",
        "tp",
    ),
    ("no messages", r"\bno (?:data|messages?|msgs?|images?|output|scans?|odom\w*|new|more|longer)\b", "tp"),
    ("heartbeat", r"heart ?beat|watch ?dog|keep[- ]?alive|time-?outs?\b|stale|zero velocity", "tp"),
    (
        "at an event",
        r"\b(?:at|on|upon|during|after) (?:start|startup|start-up|boot|launch|init\w*|connect\w*|shutdown|reset|restart"
        r"|reconnect\w*|activation|enabling|disabl\w*)",
        "tp",
    ),
    (
        "before ready",
        r"before (?:the |any |a |it |all )?\w* ?(?:subscri|connect|ready|init|publish|advertis|receiv|start)",
        "tp",
    ),
    ("wait", r"wait_?for|waiting for|wait until|\bsleep\b", "a"),
    (
        "subscribers counted",
        r"get_?num_?(?:subscribers|connections)|number of subscribers|subscribers? (?:connect|count|is"
        r"|are)|no subscribers"
        r"|\blazy|on demand",
        "a",
    ),
    ("only when", r"unchanged|only (?:when|if|on|after|once)|even (?:if|when|though)|regardless|unconditional", "tp"),
)

_OTHER = (
    (
        "crash",
        r"seg(?:mentation)? ?fault|sigsegv|core dump|\bcrash\w*|sigabrt|\babort\w*|\bassert(?:ion)?\b|terminate called"
        r"|double free|backtrace|\bgdb\b|valgrind|memory leak|deadlock|race condition|\bhang(?:s"
        r"|ing)?\b|freez\w+|mutex",
        "a",
    ),
    (
        "wish",
        r"(?:feature|enhancement) request|would be (?:nice|great|useful|good|helpful|cool|handy|awesome)|it'?d be"
        r"|(?:i would|i'd) like|we (?:should|could)|allow (?:to|for|the|user)|please add|ability to"
        r"|propos|suggest|\bwish"
        r"|add (?:support|an?|the|option|ability|method|parameter)|nice to have|\bimplement|\btodo\b",
        "tp",
    ),
    (
        "how-to",
        r"how (?:to|do|can|would|should)|is (?:it|there) (?:possible|any|a way)|what is|can (?:i|someone|anyone|we)"
        r"|does anyone|why (?:is|does|do)|\?\s{0,3}$",
        "tp",
    ),
    ("question", r"^(?:how|what|is|can|why|does|where|which)\b|\?\s{0,3}$", "t"),
    ("licence", r"licen[cs]e|copyright|\bauthor|maintainer", "a"),
    ("bag", r"\bros ?bags?\b|\bbag file", "tp"),
    ("service or action", r"\bservices?\b|\bactions?\b|actionlib|\bclient\b|\bserver\b", "tp"),
    (
        "change named",
        r"^\s{0,3}(?:fix(?:es|ed)?|add(?:s|ed)?|removed?s?|updated?s?|support|allow|make|use"
        r"|changed?s?|improve|implement"
        r"|install|set|enable|bug ?fix)\b",
        "t",
    ),
    ("exception", r"\bexception|traceback|\bthrows?\b|typeerror|valueerror|keyerror|indexerror|nameerror", "a"),
    ("permission", r"permission|\bsudo\b|\broot\b|\budev|\bchmod", "a"),
    ("picture", r"!\[|<img|screenshot|youtube|\.png|\.gif", "a"),
    ("address", r"https?://", "a"),
    ("change for review", r"\bthis (?:pr|patch|pull request|commit|fixes)|\bmerge|\bpr\b|backport|cherry-pick", "tp"),
    ("old tracker", r"ros-pkg ticket|trac data|ticket #\d+", "a"),
)

_VOCABULARIES = {
    "documentation": "doc documentation wiki readme tutorial typo comment changelog example",
    "GUI": "gui button window dialog widget icon menu panel plugin display mouse click color colour texture plot view",
    "performance": "cpu memory performance optimize leak speed slow load efficient latency",
    "tidying": "refactor cleanup rename style lint format whitespace indent test coverage duplication cosmetic "
    "simplify",
    "continuous integration": "travis ci workflow codecov appveyor action pipeline",
    "robot model": "urdf xacro mesh collision sdf gazebo",
    "planning": "planner planning costmap plan trajectory path localization slam map amcl kinematic ik controller goal",
    "settings": "param parameter config yaml launch reconfigure rosparam option",
    "hardware": "hardware motor battery gripper sensor camera arm usb device serial kinect laser lidar",
    "viewer": "rviz rqt viewer",
}

_PATTERNS = tuple(
    (name, re.compile(pattern, re.MULTILINE if pattern.startswith("(?:^|") else 0), where)
    for name, pattern, where in (*_UPDATE, *_BUILD, *_DEPENDENCY, *_INCONSISTENCY, *_LOGIC, *_OTHER)
)
_IN = {"t": "title", "p": "text", "c": "code", "a": "report"}
_SENSES = {word: name for name, words in _VOCABULARIES.items() for word in list_general_words(words)}
_SHAPES = ("title length", "text length", "code length", "error length", "question marks", "brackets in the title")
_DISTROS = re.compile(rf"\b{_DISTRO}\b")

SIGNS: tuple[str, ...] = (
    *(f"{name} ({_IN[place]})" for name, _, where in _PATTERNS for place in where),
    *(f"{name} words" for name in _VOCABULARIES),
    *_SHAPES,
    "hardly any text",
    "code shown",
    "number of distros",
)
"""The names of the signs, in the order in which `signs_of` gives their values."""

DIGEST = hashlib.sha256(
    repr([(name, pattern.pattern, where) for name, pattern, where in _PATTERNS] + sorted(_SENSES.items())).encode()
).hexdigest()[:16]
"""Of what the signs are: a model is of use only with those that it was trained with."""


def measure_signs(parts: Parts, words: Sequence[str]) -> list[float]:
    """How strongly each of SIGNS shows in a report: log(1 + occurrences), at most 8 of which count.

    words: general_words of title and prose.
    """
    title, prose = parts.title.lower(), f"{parts.title}\n{parts.prose}"[:_PROSE].lower()
    code = f"{parts.errors[: _LOG // 2]}\n{parts.code}"[:_LOG].lower()
    places = {"t": title, "p": prose, "c": code, "a": f"{prose}\n{code}"}
    found = [
        math.log1p(sum(1 for _ in islice(pattern.finditer(places[place]), _MOST)))
        for _, pattern, where in _PATTERNS
        for place in where
    ]
    senses = dict.fromkeys(_VOCABULARIES, 0)
    for word in words[:800]:
        name = _SENSES.get(word)
        if name is not None:
            senses[name] += 1
    found.extend(math.log1p(min(count, _MOST)) for count in senses.values())
    lengths = (len(text.split()) for text in (parts.title, parts.prose, parts.code, parts.errors))
    found.extend(math.log1p(count) / 2 for count in (*lengths, parts.prose.count("?"), parts.title.count("[")))
    found.append(float(len(parts.prose) + len(parts.code) < 60))
    found.append(float(bool(parts.code)))
    found.append(min(len(set(_DISTROS.findall(prose))), 4) / 2)
    return found
