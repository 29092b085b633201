"""Python's standard library: which top-level modules a version has.

Source: the lists of modules in the library references of Python 2.7 and 3.4 to 3.14, with "What's New" of each for
additions and removals (PEP 594, PEP 632 and others).
"""


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


_ALWAYS_3 = _words(
    """
    __future__ __main__ _thread abc aifc antigravity argparse array ast atexit base64 bdb binascii bisect builtins
    bz2 cProfile calendar cmath cmd code codecs codeop collections colorsys compileall concurrent configparser
    contextlib copy copyreg crypt csv ctypes curses datetime dbm decimal difflib dis doctest email encodings
    ensurepip enum errno faulthandler fcntl filecmp fileinput fnmatch fractions ftplib functools gc genericpath
    getopt getpass gettext glob grp gzip hashlib heapq hmac html http idlelib imaplib importlib inspect io ipaddress
    itertools json keyword lib2to3 linecache locale logging lzma mailbox marshal math mimetypes mmap modulefinder
    msvcrt multiprocessing netrc nt ntpath nturl2path numbers opcode operator optparse os pathlib pdb pickle
    pickletools pkgutil platform plistlib poplib posix posixpath pprint profile pstats pty pwd py_compile pyclbr
    pydoc pydoc_data pyexpat queue quopri random re readline reprlib resource rlcompleter runpy sched select
    selectors shelve shlex shutil signal site smtplib socket socketserver sqlite3 sre_compile sre_constants
    sre_parse ssl stat statistics string stringprep struct subprocess symtable sys sysconfig syslog tabnanny tarfile
    tempfile termios test textwrap this threading time timeit tkinter token tokenize trace traceback tracemalloc tty
    turtle turtledemo types unicodedata unittest urllib uuid venv warnings wave weakref webbrowser winreg winsound
    wsgiref xml xmlrpc zipapp zipfile zipimport zlib asyncio
    """
)
_ADDED = {"zipapp": 5, "typing": 5, "secrets": 6, "contextvars": 7, "dataclasses": 7, "zoneinfo": 9, "graphlib": 9,
          "tomllib": 11, "_colorize": 13, "annotationlib": 14, "compression": 14}  # fmt: skip
"""Module to the minor version of Python 3 that brought it."""

_REMOVED = {
    8: "macpath",
    9: "dummy_threading=threading",
    10: "formatter parser=ast symbol",
    11: "binhex",
    12: "asynchat=asyncio asyncore=asyncio distutils=setuptools imp=importlib smtpd=aiosmtpd",
    13: """
        aifc audioop cgi=urllib.parse cgitb=traceback chunk crypt=hashlib imghdr=filetype lib2to3 mailcap=mimetypes
        msilib nis nntplib ossaudiodev pipes=subprocess sndhdr=filetype spwd sunau telnetlib=telnetlib3 uu=base64 xdrlib
    """,
}
"""The minor version of Python 3 that lacks modules first, and these with what serves instead."""

_PYTHON_2_ONLY = """
    BaseHTTPServer=http.server Bastion CGIHTTPServer=http.server ConfigParser=configparser Cookie=http.cookies
    DocXMLRPCServer=xmlrpc.server HTMLParser=html.parser MimeWriter=email Queue=queue
    ScrolledText=tkinter.scrolledtext SimpleHTTPServer=http.server SimpleXMLRPCServer=xmlrpc.server
    SocketServer=socketserver StringIO=io Tix=tkinter.tix Tkconstants=tkinter.constants Tkinter=tkinter
    UserDict=collections UserList=collections UserString=collections __builtin__=builtins anydbm=dbm
    cPickle=pickle cStringIO=io commands=subprocess compiler=ast cookielib=http.cookiejar copy_reg=copyreg
    dbhash=dbm dircache=os dl=ctypes dumbdbm=dbm.dumb dummy_thread=_thread exceptions=builtins fpformat
    future_builtins=builtins gdbm=dbm.gnu hotshot=cProfile htmlentitydefs=html.entities htmllib=html.parser
    httplib=http.client ihooks imputil=importlib linuxaudiodev markupbase=_markupbase md5=hashlib mhlib=mailbox
    mimetools=email mimify=email multifile=email mutex=threading new=types os2emxpath popen2=subprocess
    posixfile=fcntl repr=reprlib rexec rfc822=email robotparser=urllib.robotparser sets=builtins
    sgmllib=html.parser sha=hashlib statvfs=os strop thread=_thread tkColorChooser=tkinter.colorchooser
    tkCommonDialog=tkinter.commondialog tkFileDialog=tkinter.filedialog tkFont=tkinter.font
    tkMessageBox=tkinter.messagebox tkSimpleDialog=tkinter.simpledialog toaiff ttk=tkinter.ttk
    urllib2=urllib.request urlparse=urllib.parse user whichdb=dbm xmllib=xml.sax xmlrpclib=xmlrpc.client
"""
"""Modules of Python 2.7, with their homes in Python 3."""

_NOT_IN_2 = _words(
    """
    _thread asyncio builtins concurrent configparser copyreg dbm ensurepip enum faulthandler html http ipaddress
    lzma nt pathlib queue reprlib selectors socketserver statistics tkinter tracemalloc turtledemo venv winreg
    xmlrpc zipapp
    """
)


_SUCCESSORS = {
    word.partition("=")[0]: word.partition("=")[2]
    for words in (_PYTHON_2_ONLY, *_REMOVED.values())
    for word in words.split()
}
_REMOVED_IN = {word.partition("=")[0]: minor for minor, words in _REMOVED.items() for word in words.split()}
_TOP_2 = _SUCCESSORS.keys() - _REMOVED_IN.keys()


def stdlib(module: str, minor: int, major: int = 3) -> bool:
    """True when a module (its first dotted part counts) is in the standard library of Python major.minor.

    minor: 4 to 14 for Python 3; for Python 2 it does not matter, 2.7 stands. A version outside that range is answered
    as the nearest one.
    """
    name = module.partition(".")[0]
    if major == 2:
        return name in _TOP_2 or (name in _ALWAYS_3 and name not in _NOT_IN_2) or name in _REMOVED_IN
    if name in _REMOVED_IN:
        return minor < _REMOVED_IN[name]
    if name in _ADDED:
        return minor >= _ADDED[name]
    return name in _ALWAYS_3 or (name.startswith("_") and name in _PRIVATE)


def successor_of(module: str) -> str:
    """What serves instead of a module that Python 3 lacks; empty where nothing does."""
    return _SUCCESSORS.get(module.partition(".")[0], "")


def stood_in_for(module: str) -> bool:
    """True for what a package that most machines have brings back: setuptools does with distutils."""
    return module.partition(".")[0] == "distutils"


def ever_stdlib(module: str) -> bool:
    """True when any version of Python, 2.7 included, has or had the module in its standard library."""
    name = module.partition(".")[0]
    return name in _ALWAYS_3 or name in _ADDED or name in _REMOVED_IN or name in _TOP_2 or name in _PRIVATE


_PRIVATE = _words(
    """
    _abc _ast _asyncio _bisect _bootlocale _bz2 _codecs _collections _collections_abc _compat_pickle _compression
    _contextvars _csv _ctypes _curses _curses_panel _datetime _dbm _decimal _elementtree _functools _gdbm _hashlib
    _heapq _imp _io _json _locale _lsprof _lzma _markupbase _multibytecodec _multiprocessing _opcode _operator
    _osx_support _pickle _posixshmem _posixsubprocess _py_abc _pydatetime _pydecimal _pyio _queue _random _signal
    _sitebuiltins _socket _sqlite3 _sre _ssl _stat _statistics _string _strptime _struct _symtable _sysconfigdata
    _threading_local _tkinter _tracemalloc _typing _uuid _warnings _weakref _weakrefset _winapi _zoneinfo
    """
)
