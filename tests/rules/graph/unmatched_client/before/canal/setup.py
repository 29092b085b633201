from setuptools import setup

setup(
    name='canal',
    version='1.2.0',
    packages=['canal'],
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/canal']),
        ('share/canal', ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    entry_points={'console_scripts': ['lock = canal.lock:main', 'barge = canal.barge:main']},
)
